// Polygons that cross, touch or cover themselves: what they hold by the even-odd rule, told by rays
// in long double.
#include "frontend/scene/polygon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "frontend/scene/scene_builder.hpp"

namespace grelha {
namespace {

using Vertices = std::vector<Float3>;
using Result = PolygonSplitter::Result;
using Wide = long double;

struct Wide2 {
  Wide x, y;
};

/// Which axes of the polygon's plane the oracle looks along.
struct View {
  int u = 0, v = 1;
  Wide2 operator()(const Float3& p) const {
    const Wide all[] = {p.x, p.y, p.z};
    return {all[u], all[v]};
  }
};

Wide cross(const Wide2& o, const Wide2& a, const Wide2& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

Wide distance(const Wide2& p, const Wide2& a, const Wide2& b) {
  const Wide x = b.x - a.x, y = b.y - a.y, squared = x * x + y * y;
  const Wide t =
      squared == 0 ? 0 : std::clamp<Wide>(((p.x - a.x) * x + (p.y - a.y) * y) / squared, 0, 1);
  return std::hypot(p.x - a.x - t * x, p.y - a.y - t * y);
}

Wide distance(const Wide2& p, const std::vector<Wide2>& outline) {
  Wide least = distance(p, outline.back(), outline.front());
  for (std::size_t i = 0; i + 1 < outline.size(); ++i)
    least = std::min(least, distance(p, outline[i], outline[i + 1]));
  return least;
}

/// A ray to the right meets an odd number of sides.
bool is_inside(const std::vector<Wide2>& outline, const Wide2& p) {
  bool inside = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Wide2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    if ((a.y > p.y) != (b.y > p.y) && (cross(a, b, p) > 0) == (b.y > a.y))
      inside = !inside;
  }
  return inside;
}

struct Filled {
  Result result = Result::kCut;
  Triangles triangles;
};

/// As a scene has it: what is drawn, with crossings as vertices.
Filled fill(const Vertices& corner_points) {
  SceneFile file;
  Filled filled;
  SceneBuilder(file).polygon(corner_points, {}, 0, [&](Result result) { filled.result = result; });
  filled.triangles = file.scene.geometry.triangles;
  return filled;
}

std::vector<Wide2> seen(const Triangles& t, const View& view) {
  std::vector<Wide2> points;
  for (std::size_t i = 0; i < t.x.size(); ++i)
    points.push_back(view({t.x[i], t.y[i], t.z[i]}));
  return points;
}

/// Each side of a triangle is that of another as well, or lies on the outline: nothing is seen
/// between two. `slack`: by how much vertices may lie off a side.
void expect_no_gaps(const Triangles& t,
                    const std::vector<Wide2>& points,
                    const std::vector<Wide2>& outline,
                    Wide slack) {
  std::map<std::pair<Wide, Wide>, std::uint32_t> first_index;  // corners may repeat
  const auto at = [&](std::uint32_t i) {
    return first_index.try_emplace({points[i].x, points[i].y}, i).first->second;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const std::uint32_t a = at(t.a[i]), b = at(t.b[i]), c = at(t.c[i]);
    if (a == b || b == c || c == a)
      continue;  // seen from here, it has no area
    for (const auto& side : {std::pair(a, b), {b, c}, {c, a}})
      ++sides[side];
  }
  for (const auto& [side, count] : sides) {
    EXPECT_EQ(count, 1);
    if (sides.contains({side.second, side.first}))
      continue;
    const Wide2 &a = points[side.first], &b = points[side.second];
    for (const Wide part : {0.L, .3L, .5L, .8L, 1.L}) {
      const Wide2 on{a.x + part * (b.x - a.x), a.y + part * (b.y - a.y)};
      EXPECT_LE(distance(on, outline), slack)
          << "a side within the polygon that no other triangle has";
    }
  }
}

/// Random points lie in one triangle where the oracle says inside, in none elsewhere; triangles
/// share their sides. `slack` is what vertices are rounded by.
void expect_even_odd(const Vertices& corner_points, const View& view, int samples, Wide slack) {
  const Filled filled = fill(corner_points);
  std::vector<Wide2> outline;
  for (const Float3& p : corner_points)
    outline.push_back(view(p));
  const Triangles& t = filled.triangles;
  const std::vector<Wide2> points = seen(t, view);
  const auto [x_low, x_high] = std::ranges::minmax(outline, {}, &Wide2::x);
  const auto [y_low, y_high] = std::ranges::minmax(outline, {}, &Wide2::y);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-.05, 1.05);
  for (int i = 0; i < samples; ++i) {
    const Wide2 p{x_low.x + unit(random) * (x_high.x - x_low.x),
                  y_low.y + unit(random) * (y_high.y - y_low.y)};
    if (distance(p, outline) <= 2 * slack)
      continue;
    int holding = 0;
    for (std::size_t k = 0; k < t.size(); ++k) {
      const Wide2 &a = points[t.a[k]], &b = points[t.b[k]], &c = points[t.c[k]];
      const Wide s1 = cross(a, b, p), s2 = cross(b, c, p), s3 = cross(c, a, p);
      holding += (s1 > 0 && s2 > 0 && s3 > 0) || (s1 < 0 && s2 < 0 && s3 < 0) ? 1 : 0;
    }
    ASSERT_EQ(holding, is_inside(outline, p) ? 1 : 0) << "at " << double(p.x) << ' ' << double(p.y);
  }
  expect_no_gaps(t, points, outline, slack);
}

constexpr Wide kSlack = 1e-6L;  ///< of coordinates up to 4, a few last places of a float

Vertices in_plane(const std::vector<std::array<float, 2>>& flat) {
  Vertices corner_points;
  for (const auto& [x, y] : flat)
    corner_points.push_back({x, y, 0});
  return corner_points;
}

/// Corners at equal steps round a circle, every `step`-th in turn.
Vertices star(int corner_points, int step) {
  Vertices star;
  for (int i = 0; i < corner_points; ++i) {
    const double angle = 2 * std::numbers::pi * i * step / corner_points;
    star.push_back({float(std::sin(angle)), float(std::cos(angle)), 0});
  }
  return star;
}

Vertices turned(const Vertices& flat) {
  Vertices tilted;
  for (const Float3& p : flat)  // orthogonal, no axis near another
    tilted.push_back({float(.36 * p.x + .48 * p.y + 1),
                      float(-.8 * p.x + .6 * p.y),
                      float(.48 * p.x + .64 * p.y - 2)});
  return tilted;
}

struct Shape {
  const char* what;
  Vertices corner_points;
  double area;  ///< by the even-odd rule
  Result result;
};

const std::vector<Shape> kShapes{
    {"bow tie", in_plane({{0, 0}, {1, 1}, {1, 0}, {0, 1}}), .5, Result::kFilled},
    {"bow tie with unlike wings", in_plane({{0, 0}, {3, 3}, {3, 0}, {0, 1}}), -1, Result::kFilled},
    {"bow tie that meets in a corner",
     in_plane({{0, 0}, {1, 1}, {2, 2}, {2, 0}, {1, 1}, {0, 2}}),
     2,
     Result::kFilled},
    {"two squares that touch, turning alike",
     in_plane({{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {0, 1}}),
     2,
     Result::kCut},
    {"square gone round twice",
     in_plane({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}, {1, 0}, {1, 1}, {0, 1}}),
     0,
     Result::kFilled},
    {"square gone round three times",
     in_plane({{0, 0},
               {1, 0},
               {1, 1},
               {0, 1},
               {0, 0},
               {1, 0},
               {1, 1},
               {0, 1},
               {0, 0},
               {1, 0},
               {1, 1},
               {0, 1}}),
     1,
     Result::kFilled},
    {"square within, turning alike",
     in_plane({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {3, 1}, {3, 3}, {1, 3}, {1, 1}}),
     12,
     Result::kFilled},
    {"keyhole",
     in_plane({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}}),
     12,
     Result::kCut},
    {"two that share a part of a side",
     in_plane(
         {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {4, 2}, {4, 1}, {2, 1}, {2, 0.5f}, {0, 0.5f}}),
     -1,
     Result::kFilled},
    {"spike", in_plane({{0, 0}, {2, 0}, {2, 3}, {2, 2}, {0, 2}}), 4, Result::kCut},
    {"spike across",
     in_plane({{0, 0}, {2, 0}, {2, 2}, {1, 2}, {1, -1}, {1, 2}, {0, 2}}),
     4,
     Result::kCut},
    {"corner on a side", in_plane({{0, 0}, {4, 0}, {4, 2}, {2, 0}, {0, 2}}), 4, Result::kCut},
    {"corner through a side",
     in_plane({{0, 0}, {4, 0}, {4, 2}, {2, -1}, {0, 2}}),
     -1,
     Result::kFilled},
    {"side through a corner",
     in_plane({{0, 2}, {4, 2}, {4, 4}, {2, 2}, {0, 0}}),
     4,
     Result::kFilled},
    {"pentagram", star(5, 2), -1, Result::kFilled},
    {"heptagram", star(7, 3), -1, Result::kFilled},
    {"hexagram in one stroke", star(12, 5), -1, Result::kFilled},
    {"star of many crossings", star(101, 50), -1, Result::kFilled},
};

double area_of(const Triangles& t) {
  double sum = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const std::size_t a = t.a[i], b = t.b[i], c = t.c[i];
    const double ux = double(t.x[b]) - t.x[a], uy = double(t.y[b]) - t.y[a],
                 uz = double(t.z[b]) - t.z[a];
    const double vx = double(t.x[c]) - t.x[a], vy = double(t.y[c]) - t.y[a],
                 vz = double(t.z[c]) - t.z[a];
    sum += std::hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx) / 2;
  }
  return sum;
}

TEST(CrossedPolygons, AreFilledEvenOdd) {
  for (const Shape& shape : kShapes) {
    SCOPED_TRACE(shape.what);
    Vertices corner_points = shape.corner_points;
    for (std::size_t shift = 0;
         shift < std::min<std::size_t>(corner_points.size(), 1 + 100 / corner_points.size());
         ++shift) {
      std::ranges::rotate(corner_points, corner_points.begin() + 1);
      for (const Vertices& one :
           {corner_points, Vertices(corner_points.rbegin(), corner_points.rend())}) {
        const Filled filled = fill(one);
        EXPECT_EQ(filled.result, shape.result);
        if (shape.area >= 0) {
          EXPECT_NEAR(area_of(filled.triangles), shape.area, 1e-5);
        }
        expect_even_odd(one, {0, 1}, 100, kSlack);
      }
    }
    const double area = area_of(fill(corner_points).triangles);
    const Vertices tilted = turned(corner_points);
    EXPECT_NEAR(area_of(fill(tilted).triangles), area, 1e-5) << "tilted";
    expect_even_odd(tilted, {0, 1}, 300, 4 * kSlack);
    expect_even_odd(tilted, {1, 2}, 300, 4 * kSlack);
  }
}

/// Both halves of a bow tie cancel out in its normal, and what rounding leaves of it says nothing.
TEST(CrossedPolygons, OfNoAreaInSumHaveAPlane) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 300; ++round) {
    double u[3], v[3], o[3];
    for (int k = 0; k < 3; ++k) {
      u[k] = normal(random);
      v[k] = normal(random);
      o[k] = 10 * normal(random);
    }
    const auto at = [&](double s, double t) {
      return Float3{float(o[0] + s * u[0] + t * v[0]),
                    float(o[1] + s * u[1] + t * v[1]),
                    float(o[2] + s * u[2] + t * v[2])};
    };
    const Vertices tie{at(0, 0), at(1, 1), at(1, 0), at(0, 1)};
    const double whole =
        std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
    const Filled filled = fill(tie);
    EXPECT_EQ(filled.result, Result::kFilled);
    EXPECT_NEAR(area_of(filled.triangles), whole / 2, 1e-4 * whole + 1e-4);
  }
}

/// Corners anywhere: on a coarse lattice, where most sides touch or cover others, or between.
TEST(CrossedPolygons, OfRandomCorners) {
  std::mt19937 random(11);
  for (int round = 0; round < 600; ++round) {
    const int n = 4 + int(random() % (round % 10 == 0 ? 60 : 12));
    const int lattice = round % 3 == 0 ? 3 : round % 3 == 1 ? 8 : 0;
    Vertices corner_points;
    for (int i = 0; i < n; ++i) {
      const auto coordinate = [&] {
        return lattice ? float(int(random() % unsigned(lattice)))
                       : std::uniform_real_distribution<float>(-2, 2)(random);
      };
      const float x = coordinate(), y = coordinate();
      corner_points.push_back({x, y, 0});
    }
    SCOPED_TRACE(round);
    expect_even_odd(corner_points, {0, 1}, 60, kSlack);
    if (testing::Test::HasFatalFailure())
      return;
  }
}

/// Sides that cross right beside corners and each other, by a few last places.
TEST(CrossedPolygons, OfNearlyCommonPoints) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> uniform(-1, 1), tiny(-3, 3);
  for (int round = 0; round < 200; ++round) {
    Vertices corner_points;
    for (int i = 0; i < 12; ++i) {  // lines through the middle, or so
      const double angle = uniform(random) * 3.2, x = 1 + tiny(random) * 1e-7,
                   off = tiny(random) * 6e-8;
      const double sign = i % 2 ? 1 : -1;
      corner_points.push_back({float(1 + sign * x * std::cos(angle) + off),
                               float(1 + sign * x * std::sin(angle) - off),
                               0});
    }
    SCOPED_TRACE(round);
    expect_even_odd(corner_points, {0, 1}, 60, kSlack);
    if (testing::Test::HasFatalFailure())
      return;
  }
}

/// Nobody can say where sides of a bent outline cross; they are joined half way.
TEST(CrossedPolygons, ThatAreBentHaveNoGaps) {
  std::mt19937 random(17);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (int round = 0; round < 100; ++round) {
    Vertices corner_points;
    for (int i = 0; i < 8; ++i)
      corner_points.push_back({3 * uniform(random), 3 * uniform(random), .3f * uniform(random)});
    expect_even_odd(corner_points, {0, 1}, 60, kSlack);
  }
}

TEST(CrossedPolygons, BringNormalsToTheirCrossings) {
  SceneFile file;
  const Vertices tie = in_plane({{0, 0}, {2, 2}, {2, 0}, {0, 2}});
  const Vertices normals{{0, 0, 1}, {1, 0, 1}, {1, 0, 1}, {0, 0, 1}};
  SceneBuilder(file).polygon(tie, normals, 0);
  const Triangles& t = file.scene.geometry.triangles;
  ASSERT_EQ(t.x.size(), 5u);
  EXPECT_EQ((Float3{t.x[4], t.y[4], t.z[4]}), (Float3{1, 1, 0}));
  EXPECT_EQ((Float3{t.nx[4], t.ny[4], t.nz[4]}), (Float3{.5f, 0, 1}));
}

}  // namespace
}  // namespace grelha
