// Tests outlines that are slow to triangulate, and the orientation test that triangulation depends
// on.
#include "frontend/scene/scene_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>
#include <random>

#include "frontend/scene/sweep_line.hpp"

namespace grelha {
namespace {

using Vertices = std::vector<Float3>;
using Result = PolygonSplitter::Result;

/// Whole numbers of 50 bits, whose products integers of 128 hold; three in a line, or one off it.
TEST(ExactTurn, IsRightToTheLastBit) {
  std::mt19937_64 random(3);
  const auto number = [&](int bits) {
    return std::int64_t(random() >> (64 - bits)) - (std::int64_t(1) << (bits - 1));
  };
  int in_line = 0;
  for (int i = 0; i < 200000; ++i) {
    const int bits = 2 + i % 44;
    const std::int64_t ax = number(bits), ay = number(bits), ux = number(bits), uy = number(bits);
    const std::int64_t s = number(4), t = number(4), off = number(2);
    const std::int64_t bx = ax + s * ux, by = ay + s * uy, cx = ax + t * ux + off, cy = ay + t * uy;
    __extension__ using Wide = __int128;
    const Wide exact = Wide(bx - ax) * (cy - ay) - Wide(by - ay) * (cx - ax);
    const int wanted = (exact > 0) - (exact < 0);
    const auto point = [](std::int64_t x, std::int64_t y) { return Point2{double(x), double(y)}; };
    ASSERT_EQ(exact_turn(point(ax, ay), point(bx, by), point(cx, cy)), wanted);
    in_line += wanted == 0 && s != 0 && t != 0 && s != t ? 1 : 0;
  }
  EXPECT_GT(in_line, 1000);
}

struct Filled {
  Result result = Result::kCut;
  std::size_t triangles = 0;
  double seconds = 0;  ///< of the processor, which others may be busy with
};

Filled fill(const Vertices& corner_points) {
  const std::clock_t start = std::clock();
  SceneFile file;
  Filled filled;
  SceneBuilder(file).polygon(corner_points, {}, 0, [&](Result result) { filled.result = result; });
  filled.triangles = file.scene.geometry.triangles.size();
  filled.seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
  return filled;
}

constexpr double kPatience = 30;  // .1 to 10 s were measured; for all pairs of sides it were hours

/// Simple but for one corner that is pulled across thousands of sides.
TEST(ManyCrossings, OfAMillionCornersEndSoon) {
  constexpr int kVertices = 1000000;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> decades(-6, 0);
  Vertices corner_points;
  for (int i = 0; i < kVertices; ++i) {
    const double angle = 2 * std::numbers::pi * i / kVertices, r = std::pow(10, decades(random));
    corner_points.push_back({float(r * std::cos(angle)), float(r * std::sin(angle)), 0});
  }
  corner_points[5] = {.9f, -.1f, 0};
  const Filled filled = fill(corner_points);
  EXPECT_LT(filled.seconds, kPatience);
  EXPECT_EQ(filled.result, Result::kFilled);
  EXPECT_GT(filled.triangles, corner_points.size() / 2);
}

TEST(ManyCrossings, OfNoiseEndSoon) {
  std::mt19937 random(11);
  for (const int n : {1000, 50000}) {
    for (const bool lattice : {true, false}) {
      Vertices corner_points;
      for (int i = 0; i < n; ++i) {
        const auto coordinate = [&] {
          return lattice ? float(random() % 41)
                         : std::uniform_real_distribution<float>(0, 40)(random);
        };
        const float x = coordinate(), y = coordinate();
        corner_points.push_back({x, y, 0});
      }
      const Filled filled = fill(corner_points);
      EXPECT_LT(filled.seconds, kPatience);
      EXPECT_EQ(filled.result, n > 1000 ? Result::kCutLimit : Result::kFilled);
      EXPECT_EQ(filled.triangles > 0, n == 1000);
    }
  }
}

}  // namespace
}  // namespace grelha
