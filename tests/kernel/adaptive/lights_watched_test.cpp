// Lights beside edges: how many are asked for what hides in them.
#include "kernel/adaptive/pixel_features.hpp"

#include <gtest/gtest.h>

#include "kernel/adaptive/adaptive_sampler.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

constexpr int kFirstLog = 2;

/// Balls of several pixels over a wall, and so many lights.
Scene balls_under(int lights) {
  Scene s = one_plane({0, 0, 0}, {0, 0, 1});
  Random random(3);
  for (int i = 0; i < 30; ++i)
    s.geometry.spheres.add(
        {float(random.in(-4, 4)), float(random.in(-4, 4)), float(random.in(1, 3))},
        float(random.in(.3, .6)),
        0);
  for (int i = 0; i < lights; ++i)
    s.lights.push_back({{float(random.in(-8, 8)), float(random.in(-8, 8)), 12}, {.1f, .1f, .1f}});
  return s;
}

/// Cells that are looked into for what first samples may have missed.
double cells_searched(int lights) {
  const Scene scene = balls_under(lights);
  const World world(scene, {});
  Camera camera;
  camera.eye = {0, 0, 20};
  camera.at = {0, 0, 0};
  camera.up = {0, 1, 0};
  camera.angle_deg = 25;
  camera.width = camera.height = 96;
  RenderOptions options;
  options.threads = 2;
  options.refine.error = .1;
  Refinement r = make_refinement(camera);
  RenderStats stats;
  EXPECT_TRUE(refine(world, camera, options, r, stats));
  grelha::Setup setup = set_up(world, camera, options);
  setup.plan.on = true;
  setup.plan.samples = kMostSamples;
  PixelErrors errors(r, false, kFirstLog, 2);
  errors.judge();
  TraceCounts counts;
  find_hidden_features(world.impl(), setup, errors, .001, 2, r, counts);
  return static_cast<double>(counts.visits);
}

/// Up to four lights are watched beside edges, each for about as much; of more samples tell.
TEST(LightsBesideEdges, AreWatchedUpToFour) {
  const double one = cells_searched(1);
  const double four = cells_searched(4);
  EXPECT_GT(four, 2 * one);
  EXPECT_LT(cells_searched(5), .6 * four);
}

}  // namespace
}  // namespace grelha::test
