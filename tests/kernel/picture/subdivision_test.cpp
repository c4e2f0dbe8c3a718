// Adaptive supersampling of colours that are known: against the recursion it stands for.
#include <cstring>
#include <map>
#include <set>

#include "kernel/picture/subdivision.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/recursion.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

Image subdivided(
    int width, int height, const Subdivision& options, const TracePoints& see, int tile = 0) {
  SubdivisionState picture = make_subdivision(width, height);
  check_subdivision(options);
  const Tiles tiles(picture.image, options, tile);
  for (std::size_t t = 0; t < tiles.size(); ++t)
    subdivide(tiles[t], options, see, picture.image);
  return std::move(picture.image);
}

/// Discs on top of each other, in eighths from -1/4 to 2: every mean of such colours is exact in
/// double.
Colour random_discs(std::uint64_t seed, double width, double height) {
  struct Disc {
    double x, y, radius;
    Float3 colour;
  };
  Random random(seed);
  std::vector<Disc> discs;
  const auto eighths = [&] { return static_cast<float>(random.below(19)) / 8 - .25f; };
  for (int i = 0; i < 12; ++i)
    discs.push_back({random.in(0, width),
                     random.in(0, height),
                     random.log_in(.1, 6),
                     {eighths(), eighths(), eighths()}});
  return [discs](double x, double y) {
    Float3 colour{.5f, .125f, 0};
    for (const Disc& d : discs)
      if ((x - d.x) * (x - d.x) + (y - d.y) * (y - d.y) < d.radius * d.radius)
        colour = d.colour;
    return colour;
  };
}

/// Tiles see the points between them twice.
TEST(Subdivide, IsTheRecursionAndSeesItsPointsAlone) {
  const std::pair<int, int> sizes[] = {{1, 1}, {7, 5}, {1, 9}, {19, 12}};
  std::uint64_t seed = 0;
  for (const auto& [w, h] : sizes)
    for (const float threshold : {0.f, .125f, .3f, 1.f})
      for (const int depth : {0, 1, 2, 5, 8})
        for (const int tile : {0, 1, 3, 8}) {
          const Colour colour = random_discs(++seed, w, h);
          std::set<Place> seen;
          std::size_t inside = 0;
          const auto see = [&](std::span<const LatticePoint> points, Float3* colours) {
            for (const LatticePoint& p : points) {
              inside += !seen.insert({p.x, p.y}).second && p.x % 256 != 0 && p.y % 256 != 0;
              *colours++ = colour(p.x / 256., p.y / 256.);
            }
          };
          const Image image = subdivided(w, h, {true, threshold, depth}, see, tile);
          Recursion recursion(colour, threshold, depth);
          for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
              const auto wanted = recursion.pixel(std::uint32_t(x), std::uint32_t(y));
              for (std::size_t k = 0; k < 3; ++k)
                ASSERT_EQ(image.row(y)[3 * std::size_t(x) + k], static_cast<float>(wanted[k]))
                    << w << " x " << h << ", threshold " << threshold << ", depth " << depth
                    << ", tile " << tile << ", pixel " << x << ' ' << y;
            }
          ASSERT_EQ(inside, 0u) << "seen twice, depth " << depth << ", tile " << tile;
          ASSERT_EQ(seen, recursion.points()) << "depth " << depth << ", tile " << tile;
        }
}

TEST(Subdivide, RefusesWhatMakesNoSense) {
  const auto see = [](std::span<const LatticePoint>, Float3*) {};
  for (const float threshold : {-.1f, 1.01f, kNaN})
    EXPECT_THROW(subdivided(4, 4, {true, threshold, 2}, see), std::invalid_argument);
  for (const int depth : {-1, 9})
    EXPECT_THROW(subdivided(4, 4, {true, .1f, depth}, see), std::invalid_argument);
  for (const int side : {0, 65537}) {
    EXPECT_THROW(subdivided(side, 4, {true, .1f, 2}, see), std::invalid_argument);
    EXPECT_THROW(subdivided(4, side, {true, .1f, 2}, see), std::invalid_argument);
  }
  EXPECT_NO_THROW(subdivided(65536, 1, {true, 1, 8}, see));
}

TEST(Subdivide, TilesCoverThePicture) {
  for (const auto& [w, h] : {std::pair{1, 1}, {64, 64}, {65, 3}, {200, 150}})
    for (int depth = 0; depth <= kMostSubdivisions; ++depth) {
      const Image image(w, h);
      const Tiles tiles(image, {true, .1f, depth});
      std::vector<int> covered(static_cast<std::size_t>(w * h));
      for (std::size_t t = 0; t < tiles.size(); ++t) {
        const TileRect r = tiles[t];
        EXPECT_LE(std::max(r.x1 - r.x0, r.y1 - r.y0), depth < 4 ? 32 : 16);
        for (int y = r.y0; y < r.y1; ++y)
          for (int x = r.x0; x < r.x1; ++x)
            ++covered[static_cast<std::size_t>(y * w + x)];
      }
      EXPECT_EQ(std::count(covered.begin(), covered.end(), 1), w * h) << depth;
    }
}

TEST(LatticeHash, TellsPointsApart) {
  // Among n names of 32 bits chosen at random n^2 / 2^33 pairs are alike on average: 128 for 2^20,
  // give or take 11.
  std::vector<std::uint32_t> names;
  for (std::uint32_t y = 0; y < 1024; ++y)
    for (std::uint32_t x = 0; x < 1024; ++x)
      names.push_back(lattice_hash({4096 + 8 * x, 256 * 300 + 16 * y}));
  std::sort(names.begin(), names.end());
  std::size_t pairs = 0;
  for (std::size_t i = 1; i < names.size(); ++i)
    pairs += names[i] == names[i - 1];
  EXPECT_NEAR(static_cast<double>(pairs), 128, 6 * 11.3);
}

}  // namespace
}  // namespace grelha::test
