// Lamps out of focus: which are worth following, for the error that is asked for.
#include "grelha/render.hpp"

#include <gtest/gtest.h>

#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

constexpr int kSide = 32;  ///< pixels
constexpr float kShines = 10;
constexpr double kAdded = .1;  ///< to the pixels of its disc: a hundredth of it, see glows_test.cpp

/// Samples a pixel of a lamp of .05 behind a lens of 1, at twice its focus: a dim disc on nothing.
double samples_a_pixel(double error) {
  Scene s;
  s.materials.resize(1);
  s.materials[0].emission = {kShines, kShines, kShines};
  s.geometry.spheres.add({0, 0, -20}, .05f, 0);
  Camera c;
  c.eye = {0, 0, 0};
  c.at = {0, 0, -1};
  c.up = {0, 1, 0};
  c.width = c.height = kSide;
  c.angle_deg = 40;
  c.aperture = 1;
  c.focus = 10;
  RenderOptions options;
  options.refine.error = error;
  RenderStats stats;
  render(World(s, {}), c, options, stats);
  return static_cast<double>(stats.rays.primary) / (kSide * kSide);
}

/// What adds half of the error asked for is looked for until a sample meets it; what adds less is
/// left to the eight samples that each pixel begins with, and an audit's.
TEST(Lamps, AreFollowedFromHalfOfTheErrorOn) {
  EXPECT_LT(samples_a_pixel(2 * kAdded * 1.1), 10);
  EXPECT_GT(samples_a_pixel(2 * kAdded / 1.1), 12);
}

}  // namespace
}  // namespace grelha::test
