#include "frontend/scene/polygon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <numbers>
#include <random>

namespace grelha {
namespace {

using Outline = std::vector<Float3>;
using Triangle = PolygonSplitter::Triangle;

std::vector<Triangle> cut(const Outline& corners) {
  std::vector<Triangle> triangles;
  PolygonSplitter().cut(corners, triangles);
  return triangles;
}

/// Signed, in the plane z = const, seen from +z.
double area(const Float3& a, const Float3& b, const Float3& c) {
  return 0.5 *
         ((double(b.x) - a.x) * (double(c.y) - a.y) - (double(b.y) - a.y) * (double(c.x) - a.x));
}
double area(const Outline& p) {
  double sum = 0;
  for (std::size_t i = 2; i < p.size(); ++i)
    sum += area(p[0], p[i - 1], p[i]);
  return sum;
}

/// Triangles that all turn with the outline and whose areas add up to its area cover it once each:
/// any overlap would have to be paid by a gap, and every triangle is shown to turn the right way.
/// Each sum of n terms in double errs by at most n eps times the sum of their sizes.
void expect_cover(const Outline& outline, const std::vector<Triangle>& triangles) {
  const double whole = area(outline);
  double sum = 0;
  for (const auto& [a, b, c] : triangles) {
    ASSERT_LT(std::max({a, b, c}), outline.size());
    const double piece = area(outline[a], outline[b], outline[c]);
    EXPECT_GT(piece * whole, 0);
    sum += piece;
  }
  double sizes = 0;
  for (std::size_t i = 2; i < outline.size(); ++i)
    sizes += std::abs(area(outline[0], outline[i - 1], outline[i]));
  EXPECT_NEAR(sum, whole, double(outline.size()) * 2.3e-16 * 4 * sizes);
  EXPECT_LE(triangles.size(), outline.size() - 2);
}

Outline reversed(Outline p) {
  return {p.rbegin(), p.rend()};
}

void expect_cover_any_way(const Outline& outline) {
  expect_cover(outline, cut(outline));
  expect_cover(reversed(outline), cut(reversed(outline)));
  for (std::size_t shift = 1; shift < std::min<std::size_t>(outline.size(), 8); ++shift) {
    Outline turned = outline;
    std::rotate(turned.begin(), turned.begin() + std::ptrdiff_t(shift), turned.end());
    expect_cover(turned, cut(turned));
  }
}

Outline star(int corner_count, double inner) {
  Outline p;
  for (int i = 0; i < corner_count; ++i) {
    const double angle = 2 * std::numbers::pi * i / corner_count, r = i % 4 < 2 ? 1 : inner;
    p.push_back({float(r * std::cos(angle)), float(r * std::sin(angle)), 0});
  }
  return p;
}

/// A comb: teeth that point up from a spine. Half of the corners are reflex, and the spine that
/// remains at the end is a row of collinear corners.
Outline comb(int teeth) {
  Outline p{{0, 0, 0}, {float(2 * teeth), 0, 0}};
  for (int i = teeth; i-- > 0;) {
    const float left = float(2 * i + 1), right = float(2 * i + 2);
    p.insert(p.end(), {{right, 1, 0}, {right, 9, 0}, {left, 9, 0}, {left, 1, 0}});
  }
  return p;
}

TEST(Polygon, ConvexOnesBecomeFans) {
  EXPECT_EQ(cut({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).size(), 1u);
  const Outline square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_EQ(cut(square), (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  expect_cover_any_way(square);
  expect_cover_any_way(star(30, 1.0));
}

TEST(Polygon, ConcaveQuadIsSplitAtItsReflexCorner) {
  expect_cover_any_way({{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}});
}

TEST(Polygon, ConcaveOnes) {
  expect_cover_any_way(
      {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {2, 3, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}});
  expect_cover_any_way(star(144, 0.8));
  expect_cover_any_way(star(12, 0.05));
  expect_cover_any_way(comb(50));
}

/// A flat corner that no triangle has would lie on the side of one, and rays could slip through
/// beside it where the neighbour has that corner.
TEST(Polygon, CornersInARowAreAllUsed) {
  for (Outline outline :
       {Outline{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}},
        Outline{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {1, 1, 0}, {0, 2, 0}},
        Outline{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {0, 3, 0}}}) {
    for (std::size_t shift = 0; shift < outline.size(); ++shift) {
      const std::vector<Triangle> triangles = cut(outline);
      expect_cover(outline, triangles);
      std::vector<bool> used(outline.size());
      for (const Triangle& triangle : triangles)
        for (const std::uint32_t corner : triangle)
          used[corner] = true;
      EXPECT_EQ(std::count(used.begin(), used.end(), false), 0) << "shift " << shift;
      std::rotate(outline.begin(), outline.begin() + 1, outline.end());
    }
  }
}

TEST(Polygon, RepeatedCorners) {
  expect_cover_any_way({{0, 0, 0}, {0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {2, 2, 0}, {0, 2, 0}});
}

/// A square with a square hole, joined by a seam that is walked both ways.
TEST(Polygon, KeyholeKeepsItsHole) {
  expect_cover_any_way({{0, 0, 0},
                        {4, 0, 0},
                        {4, 4, 0},
                        {0, 4, 0},
                        {0, 0, 0},
                        {1, 1, 0},
                        {1, 3, 0},
                        {3, 3, 0},
                        {3, 1, 0},
                        {1, 1, 0}});
}

/// Corners at rising angles around a point, at any distance: simple, and reflex about as often as
/// not.
TEST(Polygon, RandomOutlines) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> radius(0.1f, 10.0f);
  for (int round = 0; round < 300; ++round) {
    const int n = 4 + round;
    Outline p;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      const float r = radius(random);
      p.push_back({float(r * std::cos(angle)), float(r * std::sin(angle)), 3});
    }
    expect_cover_any_way(p);
  }
}

/// Returns the interior angle of a triangle at its first corner, in radians.
double angle(const Float3& a, const Float3& b, const Float3& c) {
  const double dot =
      (double{b.x} - a.x) * (double{c.x} - a.x) + (double{b.y} - a.y) * (double{c.y} - a.y);
  return std::atan2(2 * std::abs(area(a, b, c)), dot);
}

/// No side of two triangles has angles opposite to it that sum to more than pi, unless its two
/// triangles have no other diagonal.
void expect_delaunay(const Outline& p) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> opposite;
  for (const auto& [a, b, c] : cut(p)) {
    opposite[{a, b}] = c;
    opposite[{b, c}] = a;
    opposite[{c, a}] = b;
  }
  std::size_t shared = 0;
  for (const auto& [side, r] : opposite) {
    const auto [from, to] = side;
    const auto found = opposite.find({to, from});
    if (found == opposite.end())
      continue;
    ++shared;
    const std::uint32_t s = found->second;
    if (area(p[r], p[from], p[s]) > 0 && area(p[s], p[to], p[r]) > 0) {
      EXPECT_LE(angle(p[r], p[from], p[to]) + angle(p[s], p[from], p[to]), std::numbers::pi + 1e-9);
    }
  }
  EXPECT_GE(shared, 2 * (p.size() - 3));
}

TEST(Polygon, ConcaveOnesAreDelaunay) {
  expect_delaunay(star(144, .8));
  expect_delaunay(comb(50));
  std::mt19937 random(11);
  std::uniform_real_distribution<double> radius(.1, 10);
  for (int round = 0; round < 100; ++round) {
    Outline p;
    for (int i = 0; i < 50; ++i) {
      const double at = 2 * std::numbers::pi * i / 50, r = radius(random);
      p.push_back({float(r * std::cos(at)), float(r * std::sin(at)), 0});
    }
    expect_delaunay(p);
  }
}

TEST(Polygon, AnyPlaneGivesTheSameCut) {
  const Outline flat = star(40, 0.5);
  const auto expected = cut(flat);
  Outline yz, zx;
  for (const Float3& p : flat) {
    yz.push_back({5, p.x, p.y});
    zx.push_back({p.y, 5, p.x});
  }
  EXPECT_EQ(cut(yz), expected);
  EXPECT_EQ(cut(zx), expected);
}

TEST(Polygon, NormalIsTwiceTheArea) {
  PolygonSplitter splitter;
  std::vector<Triangle> triangles;
  ASSERT_EQ(
      splitter.cut(std::vector<Float3>{{0, 0, 1}, {2, 0, 1}, {2, 3, 1}, {0, 3, 1}}, triangles),
      PolygonSplitter::Result::kCut);
  EXPECT_EQ(splitter.normal(), (std::array<double, 3>{0, 0, 12}));
}

TEST(Polygon, WithoutAreaThereIsNothing) {
  PolygonSplitter splitter;
  std::vector<Triangle> triangles;
  for (const Outline& outline :
       {Outline{{0.1f, 0.1f, 0.1f}, {0.2f, 0.2f, 0.2f}, {0.7f, 0.7f, 0.7f}, {0.3f, 0.3f, 0.3f}},
        Outline{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}},
        Outline{{1, 1, 1}, {1, 2, 1}}})
    EXPECT_EQ(splitter.cut(outline, triangles), PolygonSplitter::Result::kNoArea);
  EXPECT_TRUE(triangles.empty());
}

/// Of the processor: others may be busy with it.
double seconds_for(const Outline& outline, std::vector<Triangle>& triangles) {
  const std::clock_t start = std::clock();
  triangles = cut(outline);
  return double(std::clock() - start) / CLOCKS_PER_SEC;
}

// Generous: about 0.02 s were measured; testing every corner against every other took minutes.
constexpr double kPatience = 10;

TEST(Polygon, CombsOfManyCornersEndSoon) {
  std::vector<Triangle> triangles;
  const Outline outline = comb(25000);  // 100,002 corners
  EXPECT_LT(seconds_for(outline, triangles), kPatience);
  expect_cover(outline, triangles);
}

TEST(Polygon, SpiralsEndSoon) {
  Outline outline;
  constexpr int kTurns = 100, kSteps = 50000;
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k < kSteps; ++k) {
      const double t = side == 0 ? k : kSteps - 1 - k,
                   angle = 2 * std::numbers::pi * kTurns * t / kSteps;
      const double r = 1 + angle / (2 * std::numbers::pi) - (side == 0 ? 0 : 0.5);
      outline.push_back({float(r * std::cos(angle)), float(r * std::sin(angle)), 0});
    }
  std::vector<Triangle> triangles;
  EXPECT_LT(seconds_for(outline, triangles), kPatience);
  expect_cover(outline, triangles);
}

/// Spikes of any length that meet near the middle: every ear is a sliver among the corners of all
/// others.
TEST(Polygon, StarsOfAMillionCornersEndSoon) {
  constexpr int kVertices = 1000000;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> length(1, 2);
  for (const bool regular : {true, false}) {
    Outline outline;
    for (int i = 0; i < kVertices; ++i) {
      const double angle = 2 * std::numbers::pi * i / kVertices,
                   r = regular ? 1 + i % 2 : length(random);
      outline.push_back({float(r * std::cos(angle)), float(r * std::sin(angle)), 0});
    }
    std::vector<Triangle> triangles;
    EXPECT_LT(seconds_for(outline, triangles), kPatience);
    expect_cover(outline, triangles);
    EXPECT_EQ(triangles.size(), outline.size() - 2);
  }
}

}  // namespace
}  // namespace grelha
