// How wide meshes look beside their rims.
#include "kernel/marks/rim_walk.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>

#include "tests/support/boxes.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

constexpr double kWide = 1e30;  ///< enough for nothing

/// Calls visit(strip, rim) for each edge at a rim of a mesh, as seen from a point.
template <class Visit>
void each_strip(const Triangles& t, const double (&from)[3], double enough, const Visit& visit) {
  const TriangleSpans spans(t);
  MeshRims rims(spans, 1);
  const SeenFrom point{{from[0], from[1], from[2]}};
  rims.look_from({&point, 1});
  const RimWalk walk(spans, rims, 0, point.at);
  for (std::size_t i = 0; i < t.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      if (rims.rims(i, 0) >> k & 1) {
        const Rod strip = walk.strip(i, k, enough);
        EXPECT_TRUE(walk.may_be_thin(i, k, enough) || strip.width >= enough);
        visit(strip, walk.edge(i, k));
      }
}

/// A band along x, from y = 0 to `width`, cut at random places of either side.
Scene band(Random& random, float width, int cuts) {
  Scene s = empty_scene();
  Float3 lower{0, 0, 0};
  Float3 upper{0, width, 0};
  for (int i = 0; i < cuts; ++i) {
    const bool at_lower = i + 2 == cuts || (i + 1 != cuts && random.chance(.5));
    Float3& last = at_lower ? lower : upper;
    Float3 next = last;
    next.x = i + 2 < cuts ? last.x + random.in(0, 2) : std::max(lower.x, upper.x) + 1;
    add_triangle(s, lower, upper, next);
    last = next;
  }
  return s;
}

/// Seen straight on it is as wide as it is, whatever its triangles; of what is wider than enough no
/// more is told.
TEST(RimWalk, TellsTheWidthOfBands) {
  Random random(1);
  const double from[3] = {5, 3, 1e6};
  for (int i = 0; i < 100; ++i) {
    const float width = random.log_in(.01, 1);
    const Scene s = band(random, width, 30);
    int sides = 0;
    each_strip(s.geometry.triangles, from, kWide, [&](const Rod& strip, const Rod& edge) {
      if (edge.end[0][1] != edge.end[1][1])
        return;  // an end of the band
      ++sides;
      EXPECT_NEAR(strip.width / width, 1, 1e-5);
      EXPECT_NEAR(strip.end[0][1], width / 2, 1e-5);
      EXPECT_NEAR(strip.aside, strip.width / 2, 1e-12);
      EXPECT_NEAR(strip.length(), edge.length(), 1e-9);
    });
    EXPECT_EQ(sides, 30);
    each_strip(s.geometry.triangles, from, width / 2, [&](const Rod& strip, const Rod&) {
      EXPECT_GE(strip.width, width / 2);
    });
  }
}

/// Slivers of a large polygon are no thin things, though some have an edge at its rim. From side to
/// side it is 2 cos(pi / 90) wide; from so far away perspective takes a part in 10^8.
TEST(RimWalk, TellsThatPolygonsAreWide) {
  Scene s = empty_scene();
  constexpr int kCorners = 90;
  const auto place = [](int k) {
    const double angle = 2 * std::numbers::pi * k / kCorners;
    return Float3{static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0};
  };
  for (int k = 1; k + 1 < kCorners; ++k)
    add_triangle(s, place(0), place(k), place(k + 1));
  each_strip(s.geometry.triangles, {.1, -.2, 1e4}, kWide, [&](const Rod& strip, const Rod&) {
    EXPECT_NEAR(strip.width, 2 * std::cos(std::numbers::pi / kCorners), 1e-5);
  });
}

/// Of a box seen along an axis front and back show, the latter by way of the sides, which are half
/// a unit deep: seen from 1000 away that is a part in 2000.
TEST(RimWalk, GoesAroundEdgesThatAreNoRims) {
  Scene s = empty_scene();
  const double length[3] = {3, 2, .5};
  add_box(s, {0, 0, 0}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, length);
  int rims = 0;
  each_strip(s.geometry.triangles, {0, 0, 1000}, kWide, [&](const Rod& strip, const Rod& edge) {
    ++rims;
    const double across = edge.end[0][0] == edge.end[1][0] ? 3 : 2;
    EXPECT_NEAR(strip.width / across, 1, 6e-4);
  });
  EXPECT_EQ(rims, 8) << "of front and sides, or of sides and back";
}

/// Seen along its axis a ball is as wide as it looks: it turns away along one of its rings, near
/// where a round ball does, which is 1 - cos(pi / 16) = .02 wider than the next at most. The 32
/// sides of a ring are .005 nearer than its corners.
TEST(RimWalk, CrossesBalls) {
  const Scene ball = ball_mesh(32, 16);
  for (const double away : {5., 20., 1000.}) {
    const double looks = 2 * away / std::sqrt(away * away - 1);  // at the distance of its rim
    each_strip(ball.geometry.triangles, {0, away, 0}, kWide, [&](const Rod& strip, const Rod&) {
      EXPECT_NEAR(strip.width / looks, 1, .025) << away;
    });
  }
}

/// Of a long way across very many triangles no more is told than was gone.
TEST(RimWalk, EndsAfterManyTriangles) {
  Scene s = empty_scene();
  for (int i = 0; i < 100; ++i) {
    const auto y = static_cast<float>(i);
    add_triangle(s, {0, y, 0}, {9, y, 0}, {9, y + 1, 0});
    add_triangle(s, {0, y, 0}, {9, y + 1, 0}, {0, y + 1, 0});
  }
  each_strip(s.geometry.triangles, {4, 50, 1e6}, kWide, [&](const Rod& strip, const Rod& edge) {
    EXPECT_NEAR(strip.width, edge.end[0][1] == edge.end[1][1] ? 32 : 9, 1e-4);
  });
}

/// What reaches behind the viewpoint is as wide as told so far, and so is an edge seen end on.
TEST(RimWalk, IsNarrowWhereNobodyCanTell) {
  Scene s = empty_scene();
  add_triangle(s, {-1, 1, -5}, {1, 1, -5}, {0, 1, 5});
  each_strip(s.geometry.triangles, {0, 0, 0}, kWide, [&](const Rod& strip, const Rod& edge) {
    if (edge.end[0][2] == edge.end[1][2])
      EXPECT_EQ(strip.width, 0);
  });
  Scene on = empty_scene();
  add_triangle(on, {0, 0, -5}, {0, 0, -6}, {1, 0, -5});
  each_strip(on.geometry.triangles, {0, 0, 0}, kWide, [&](const Rod& strip, const Rod&) {
    EXPECT_FALSE(strip.width > 1e-12);
  });
}

}  // namespace
}  // namespace grelha::test
