// Adaptive supersampling of colours that are known: against the recursion it stands for.
#include <cstring>
#include <map>
#include <set>

#include "kernel/subdivision/subdivider.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/recursion.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

Image subdivided(
    int width, int height, const Subdivision& options, const TracePoints& see, int tile = 0) {
  SubdivisionState picture = make_subdivision(width, height);
  subdivide(picture, options, see, tile);
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

TEST(Subdivide, IsTheRecursionAndSeesNoPointTwice) {
  const std::pair<int, int> sizes[] = {{1, 1}, {7, 5}, {1, 9}, {19, 12}};
  std::uint64_t seed = 0;
  for (const auto& [w, h] : sizes)
    for (const float threshold : {0.f, .125f, .3f, 1.f})
      for (const int depth : {0, 1, 2, 5, 8})
        for (const int tile : {0, 1, 3, 8}) {
          const Colour colour = random_discs(++seed, w, h);
          std::set<Place> seen;
          std::size_t twice = 0;
          const auto see = [&](std::span<const LatticePoint> points,
                               Float3* colours,
                               double,
                               double) {
            for (const LatticePoint& p : points)
              twice += !seen.insert({p.x, p.y}).second, *colours++ = colour(p.x / 256., p.y / 256.);
            return points.size();
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
          ASSERT_EQ(twice, 0u) << "depth " << depth << ", tile " << tile;
          ASSERT_EQ(seen, recursion.points()) << "depth " << depth << ", tile " << tile;
        }
}

TEST(Subdivide, RefusesWhatMakesNoSense) {
  const auto see = [](std::span<const LatticePoint>, Float3*, double, double) {
    return std::size_t{0};
  };
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

TEST(Subdivide, StopsWhenToldAndTellsHowFarItIs) {
  const Colour colour = random_discs(3, 8, 8);
  std::size_t calls = 0, stop_at = 0;
  double last = 0;
  const auto see =
      [&](std::span<const LatticePoint> points, Float3* colours, double from, double to) {
        EXPECT_GE(from, last - 1e-12);
        EXPECT_LE(from, to);
        last = to;
        if (++calls == stop_at)
          return std::size_t{0};
        for (const LatticePoint& p : points)
          *colours++ = colour(p.x / 256., p.y / 256.);
        return points.size();
      };
  const Image whole = subdivided(8, 8, {true, .1f, 2}, see, 4);
  EXPECT_EQ(calls, 12u) << "four tiles, three levels";
  EXPECT_NEAR(last, 1, 1e-12);
  calls = 0;
  stop_at = 8;
  last = 0;
  const Image part = subdivided(8, 8, {true, .1f, 2}, see, 4);
  EXPECT_EQ(calls, 8u);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      if (y >= 4 && x < 4)
        continue;
      EXPECT_EQ(part.row(y)[3 * x], y < 4 ? whole.row(y)[3 * x] : 0)
          << x << ' ' << y << ": two tiles are finished, one is not begun";
    }
  // Of the third tile the corners are there, and no more.
  const Image corners =
      subdivided(8, 8, {true, .1f, 0}, [&](auto points, Float3* colours, double, double) {
        for (const LatticePoint& p : points)
          *colours++ = colour(p.x / 256., p.y / 256.);
        return points.size();
      });
  for (int y = 4; y < 8; ++y)
    for (int x = 0; x < 4; ++x)
      EXPECT_EQ(part.row(y)[3 * x], corners.row(y)[3 * x]) << x << ' ' << y;
}

/// Points are seen a few at a time, in a picture that is copied between them: none is seen twice,
/// and the picture is that made in one go.
TEST(Subdivide, StoppedAnywhereGoesOnToTheSameBits) {
  Random random(4);
  for (const int tile : {0, 3, 8})
    for (const int depth : {0, 1, 4}) {
      SCOPED_TRACE(testing::Message() << "tile " << tile << ", depth " << depth);
      const Colour colour = random_discs(11, 19, 12);
      std::set<Place> seen;
      std::size_t twice = 0, most = ~std::size_t{0};
      const auto see = [&](std::span<const LatticePoint> points, Float3* colours, double, double) {
        const std::size_t n = std::min(points.size(), most);
        for (const LatticePoint& p : points.first(n))
          twice += !seen.insert({p.x, p.y}).second, *colours++ = colour(p.x / 256., p.y / 256.);
        return n;
      };
      const Image whole = subdivided(19, 12, {true, .1f, depth}, see, tile);
      const std::set<Place> all = std::exchange(seen, {});
      SubdivisionState kept = make_subdivision(19, 12);
      for (bool done = false; !done;) {
        SubdivisionState copy = kept;
        most = random.below(100);
        done = subdivide(copy, {true, .1f, depth}, see, tile);
        ASSERT_TRUE(is_sound(copy));
        ASSERT_GE(copy.share, kept.share);
        kept = std::move(copy);
      }
      EXPECT_EQ(kept.share, 1);
      EXPECT_EQ(kept.image.rgb, whole.rgb);
      EXPECT_EQ(seen, all);
      EXPECT_EQ(twice, 0u);
      EXPECT_TRUE(subdivide(kept, {true, .1f, depth}, see, tile)) << "nothing is left to do";
      EXPECT_EQ(twice, 0u);
    }
}

/// Until all corners are seen a pixel shows its first, then squares that wait to be split show
/// theirs: all of it lies between what was seen.
TEST(Subdivide, ShowsOfATileWhatThereIs) {
  SubdivisionState picture = make_subdivision(16, 8);
  const auto see_some = [](std::span<const LatticePoint> points, Float3* colours, double, double) {
    // corners come in blocks of 8 x 8
    const std::size_t n = std::min<std::size_t>(points.size(), 64);
    for (std::size_t i = 0; i < n; ++i)
      colours[i] = {static_cast<float>(points[i].x / 256), 0, 0};
    return n;
  };
  EXPECT_FALSE(subdivide(picture, {true, .1f, 0}, see_some));
  for (int x = 0; x < 16; ++x)
    EXPECT_EQ(picture.image.row(3)[3 * x], x < 8 ? x : 0) << x;
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
