// What lists hold, in floats: what lies inside of a side to the last bit of a double is never
// outside of it, however far the list's tile is from where its primitive begins; and a box of no
// width holds its place in parts of parts of a tile.
#include <gtest/gtest.h>

#include <cmath>

#include "kernel/perspective/in_tiles.hpp"
#include "kernel/trace/point_lookup.hpp"
#include "tests/support/random.hpp"

namespace grelha::test {
namespace {

using Outline = scalar::Outline<double>;
using HalfPlane = scalar::HalfPlane<double>;

/// A face of so many tiles along each axis.
PointFace face_of(double tiles) {
  PointFace face;
  face.u = face.v = -1;
  face.nx = face.ny = tiles;
  face.per_u = face.per_v = tiles / 2;
  return face;
}

/// A side through a place of a face that leaves nothing open by itself, and bounds of its primitive
/// that begin `span` tiles before the place, at most.
Outline side_through(Random& random, const PointFace& face, const double (&place)[2], double span) {
  Outline o = {};
  const double angle = random.in(0, 6.28);
  const double size = random.log_in(1e-3, 1e3);
  for (HalfPlane& s : o.side) {
    s.a = size * std::cos(angle);
    s.b = size * std::sin(angle);
    s.c = -(s.a * place[0] + s.b * place[1]);
  }
  for (int j = 0; j < 2; ++j) {
    const double reach = random.in(0, span) / face.per_u;
    o.lo[j] = std::max(place[j] - reach, -1.);
    o.hi[j] = std::min(place[j] + random.in(0, .1), 1.);
  }
  return o;
}

/// As look-ups evaluate it, at a place of the tile that holds it.
float evaluated(const Outline& tiled, const PointFace& face, const double (&place)[2]) {
  double at[2], corner[2];
  for (int j = 0; j < 2; ++j) {
    const double in_tiles = (place[j] - (j == 0 ? face.u : face.v)) * face.per_u;
    corner[j] = std::min(std::floor(in_tiles), face.nx - 1);
    at[j] = in_tiles - corner[j];
  }
  SeenFew kept = {};
  scalar::keep(face, tiled, 0, kept);
  OutlineBlock block;
  set_place(block, 0, SeenOutline(kept, 0, 0), {corner[0], corner[1], 1, 0});
  const float x = static_cast<float>(at[0]);
  const float y = static_cast<float>(at[1]);
  return (block.side[0][0][0] * x + block.side[0][1][0] * y) + block.side[0][2][0];
}

class Sides : public testing::TestWithParam<double> {};

TEST_P(Sides, HoldWhatLiesOnThem) {
  Random random(31);
  const double span = GetParam();
  const PointFace face = face_of(4096);
  for (int i = 0; i < 20000; ++i) {
    const double place[2] = {random.in(-1, 1), random.in(-1, 1)};
    Outline seen = side_through(random, face, place, span);
    scalar::to_tiles(face, seen);
    ASSERT_GE(evaluated(seen, face, place), 0) << place[0] << ' ' << place[1];
  }
}

INSTANTIATE_TEST_SUITE_P(Spans, Sides, testing::Values(1., 30., 4000.));

/// A ray's way to ever smaller parts of tiles, and what is seen exactly where it goes.
class Descent {
 public:
  Descent(const PointFace& face, double u, double v) {
    scalar::Bounds<double> seen{{u, v}, {u, v}, 1, 1};
    const double x = (u - face.u) * face.per_u;
    const double y = (v - face.v) * face.per_v;
    tile_ = {std::floor(x), std::floor(y), 1, 0};
    at_ = {static_cast<float>(x - tile_.x), static_cast<float>(y - tile_.y), 0, 0};
    scalar::to_tiles(face, seen);
    scalar::keep(face, seen, 0, seen_);
    seen_.sided = false;
    box_ = SeenBox(seen_, 0, 0);
  }
  /// Goes on to one of n x n parts; false: what is seen is not placed there.
  bool go_on(int n) {
    at_ = scalar::look_closer(at_, true, static_cast<float>(n));
    const int part = static_cast<int>(at_.tile);
    const double width = tile_.width / n;
    bool placed = false;
    TileWalk({tile_.x, tile_.y, width, n, n}).each(seen_, 0, [&](std::uint32_t number) {
      placed |= static_cast<int>(number) == part;
    });
    tile_ = {tile_.x + part % n * width, tile_.y + part / n * width, width, 0};
    return placed;
  }
  bool holds() const {
    BoxBlock b;
    set_place(b, 0, box_, tile_);
    return b.lo[0][0] <= at_.x && at_.x <= b.hi[0][0] && b.lo[1][0] <= at_.y && at_.y <= b.hi[1][0];
  }

 private:
  SeenFew seen_ = {};
  SeenBox box_;
  Tile tile_{0, 0, 1, 0};
  scalar::SearchPlaces at_;
};

TEST(Boxes, HoldTheirPlacesInParts) {
  Random random(32);
  const PointFace face = face_of(512);
  for (int i = 0; i < 20000; ++i) {
    Descent descent(face, random.in(-1, 1), random.in(-1, 1));
    ASSERT_TRUE(descent.holds()) << i;
    for (int level = 1; level <= 4; ++level) {
      const bool placed = descent.go_on(2 + static_cast<int>(random.below(15)));
      ASSERT_TRUE(placed) << i << ", level " << level;
      ASSERT_TRUE(descent.holds()) << i << ", level " << level;
    }
  }
}

}  // namespace
}  // namespace grelha::test
