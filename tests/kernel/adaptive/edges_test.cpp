// Edges: what is asked about them, and their lights.
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

/// A picture after its first samples, and what is then looked for for an error.
struct Looked {
  double cells;  ///< that are looked into for what first samples may have missed
  std::vector<float> around;
  std::vector<bool> agrees;
  std::vector<float> contrast;
};
Looked looked(const Scene& scene, double error) {
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
  r.around.assign(r.around.size(), 1);  // as though nobody had looked
  grelha::Setup setup = set_up(world, camera, options);
  setup.plan.on = true;
  setup.plan.samples = kMostSamples;
  PixelErrors errors(r, false, kFirstLog, 2);
  errors.judge();
  TraceCounts counts;
  find_hidden_features(world.impl(), setup, errors, error, 2, r, counts);
  Looked out{static_cast<double>(counts.visits), r.around, {}, {}};
  for (int p = 0; p < camera.width * camera.height; ++p) {
    out.agrees.push_back(errors.agrees(static_cast<std::size_t>(p)));
    out.contrast.push_back(errors.contrast(p % camera.width, p / camera.width));
  }
  return out;
}
double cells_searched(int lights) {
  return looked(balls_under(lights), .0001).cells;
}

/// Pixels whose samples agree are doubted as far as those around them differ: no more where these
/// are like them, and where they are less like than samples settle sooner than beams, all of it,
/// unasked.
TEST(Edges, AreDoubtedAndNothingElse) {
  constexpr double kError = .01;
  const Looked found = looked(balls_under(1), kError);
  int edges = 0;
  int plain = 0;
  for (std::size_t p = 0; p < found.agrees.size(); ++p) {
    if (!found.agrees[p])
      continue;
    if (found.contrast[p] > PixelErrors::dear(kError))
      continue;
    const bool edge = found.contrast[p] > PixelErrors::faint(kError);
    EXPECT_EQ(found.around[p], edge ? 1 : 0) << p << ' ' << found.contrast[p];
    ++(edge ? edges : plain);
  }
  EXPECT_GT(edges, 300);
  EXPECT_GT(plain, 3000);
}

/// The less error is asked for, the more edges are looked at.
TEST(Edges, AreAskedAboutWhereSamplesWouldTakeLonger) {
  const Scene scene = balls_under(1);
  EXPECT_LT(looked(scene, .03).cells, .1 * looked(scene, .0001).cells);
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
