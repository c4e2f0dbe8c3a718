// Polygons that are folded in space: the surface has their outline, or a word is said. A part of
// polygon_test.
#include "frontend/scene/polygon.hpp"
#include "frontend/scene/scene_builder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <vector>

namespace grelha {
namespace {

using Result = PolygonSplitter::Result;

/// A flat outline folded along x = 0 by an angle: nothing is lost, or something is said.
TEST(FoldedPolygons, LoseNothingSilently) {
  std::mt19937 random(19);
  std::map<Result, int> count;
  for (int round = 0; round < 2000; ++round) {
    const double fold = std::numbers::pi / 6 * (round % 7);
    std::vector<Float3> corner_points;
    double angle = 0;
    for (int i = 0; i < 7; ++i) {
      angle += std::uniform_real_distribution(.3, .9)(random);
      const double r = 1 + double(random() % 3), x = std::round(2 * r * std::cos(angle)),
                   y = std::round(2 * r * std::sin(angle));
      const bool is_bent = x > 0;
      corner_points.push_back({float(is_bent ? x * std::cos(fold) : x),
                               float(y),
                               float(is_bent ? x * std::sin(fold) : 0)});
    }
    SceneFile file;
    Result result = Result::kCut;
    SceneBuilder(file).polygon(corner_points, {}, 0, [&](Result found) { result = found; });
    ++count[result];
    const Triangles& t = file.scene.geometry.triangles;
    if (result != Result::kCut || t.size() == 0)
      continue;
    std::array<double, 3> missing = newell_sum(corner_points);
    for (std::size_t i = 0; i < t.size(); ++i) {
      const auto at = [&](std::uint32_t v) { return Float3{t.x[v], t.y[v], t.z[v]}; };
      const auto n = newell_sum(std::array{at(t.a[i]), at(t.b[i]), at(t.c[i])});
      for (std::size_t k = 0; k < 3; ++k)
        missing[k] -= n[k];
    }
    ASSERT_LT(std::hypot(missing[0], missing[1], missing[2]), .1) << round;
  }
  EXPECT_GT(count[Result::kCut], 500);
  EXPECT_GT(count[Result::kFolded], 100);
}

}  // namespace
}  // namespace grelha
