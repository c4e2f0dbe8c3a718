// How thick meshes are, and that their outlines are looked at where that is little.
#include "kernel/marks/mesh_thickness.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "kernel/render/setup.hpp"
#include "tests/support/boxes.hpp"
#include "tests/support/rays.hpp"

namespace grelha::test {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// `enough`: all that is asked.
std::vector<float> thickness_of(const Scene& scene, double enough = kInfinite) {
  const World world(scene, {});
  const Setup setup = set_up(world, Camera{}, {});
  std::vector<std::uint32_t> all(scene.geometry.triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  std::vector<float> out(all.size());
  TraceCounts counts;
  MeshThickness(world.impl(), setup).measure(all, enough, out, counts);
  return out;
}

TEST(MeshThickness, IsThatOfBoxes) {
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    const double size = random.log_in(1e-4, 1e4);
    const double away = size * random.log_in(.1, 100);
    Scene s = empty_scene();
    double length[3];
    for (double& l : length)
      l = size * random.log_in(.02, 1);
    add_box(s, at({0, 0, 0}, away, random.direction()), random_axes(random), length);
    const std::vector<float> thickness = thickness_of(s);
    ASSERT_EQ(thickness.size(), 12u);
    for (std::size_t t = 0; t < 12; ++t)
      EXPECT_NEAR(thickness[t] / length[t / 4], 1, .02) << i << ' ' << t << ' ' << away / size;
  }
}

/// The nearer of what is on either side: no mesh says which way is in.
TEST(MeshThickness, IsTheGapWhereThatIsLess) {
  const double length[3] = {1, 1, 1};
  const Axes axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (const double gap : {.01, .25, 3.}) {
    Scene s = empty_scene();
    add_box(s, {0, 0, 0}, axes, length);
    add_box(s, {static_cast<float>(1 + gap), 0, 0}, axes, length);
    const std::vector<float> thickness = thickness_of(s);
    int of_gap = 0;
    for (const float t : thickness)
      of_gap += std::abs(t - gap) < 1e-3;
    EXPECT_EQ(of_gap, gap < 1 ? 4 : 0) << gap;
  }
}

/// What is less than enough is told as it is, all else as enough or more.
TEST(MeshThickness, IsToldWhereItIsLessThanEnough) {
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    Scene s = empty_scene();
    const double length[3] = {random.log_in(.02, 1), random.log_in(.02, 1), random.log_in(.02, 1)};
    add_box(s, {0, 0, 0}, random_axes(random), length);
    const std::vector<float> thickness = thickness_of(s);
    const double enough = random.log_in(.02, 1);
    const std::vector<float> told = thickness_of(s, enough);
    for (std::size_t t = 0; t < 12; ++t) {
      if (thickness[t] < enough)
        EXPECT_EQ(told[t], thickness[t]) << i << ' ' << t;
      else
        EXPECT_GE(told[t], enough) << i << ' ' << t;
    }
  }
}

TEST(MeshThickness, IsInfiniteWhereNothingIsAndNoneOfWhatHasNoArea) {
  Scene s = empty_scene();
  add_triangle(s, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_triangle(s, {0, 0, 5}, {1, 0, 5}, {2, 0, 5});
  const std::vector<float> thickness = thickness_of(s);
  EXPECT_EQ(thickness[0], kInfinite);
  EXPECT_EQ(thickness[1], 0);
}

}  // namespace
}  // namespace grelha::test
