// Pictures are the same bits with grids in their lights' perspective and without.
#include <gtest/gtest.h>

#include "grelha/grelha.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

/// Mirrors, glass and eight lights more: outside, inside, in things.
Scene lit_from_everywhere() {
  Scene s = everything();
  const Geometry& g = s.geometry;
  for (const Float3& at : {Float3{0, 9, 0}, Float3{.1f, .2f, .3f}, Float3{-1e5f, 3e5f, 1e5f}})
    s.lights.push_back({at, {.1f, .1f, .1f}});
  s.lights.push_back({{g.triangles.x[4], g.triangles.y[4], g.triangles.z[4]}, {.1f, .1f, .1f}});
  s.lights.push_back({{g.spheres.x[2], g.spheres.y[2], g.spheres.z[2]}, {.1f, .1f, .1f}});
  return s;
}

Camera camera_of(int size) {
  Camera c;
  c.eye = {2.5f, 2, 3};
  c.at = {0, 0, 0};
  c.width = c.height = size;
  return c;
}

TEST(LightGrids, ChangeNoBitOfAPicture) {
  const Scene scene = lit_from_everywhere();
  const World world(scene, {});
  RenderOptions options;
  options.sampling.samples = 2;
  options.point_grids = PointGrids::kOff;
  RenderStats stats;
  const Image wanted = render(world, camera_of(96), options, stats);
  EXPECT_EQ(stats.point_grids.count, 0);
  options.point_grids = PointGrids::kOn;
  for (const Isa& isa : isas())
    for (const int packet : {1, 16, 256}) {
      if (!isa.compiled || !isa.runs_here)
        continue;
      options.isa = isa.name;
      options.packet = packet;
      options.threads = packet == 16 ? 3 : 1;
      const Image found = render(world, camera_of(96), options, stats);
      EXPECT_EQ(found.rgb, wanted.rgb) << isa.name << ", packets of " << packet;
      EXPECT_GE(stats.point_grids.count, 5);
      EXPECT_GT(stats.point_grids.bytes, 0u);
    }
}

TEST(LightGrids, AreBuiltWhereSamplesOutweighPrimitives) {
  const Scene scene = lit_from_everywhere();
  const World world(scene, {});
  RenderOptions options;
  RenderStats stats;
  render(world, camera_of(8), options, stats);
  EXPECT_EQ(stats.point_grids.count, 0);
  render(world, camera_of(96), options, stats);
  EXPECT_GT(stats.point_grids.count, 0);
}

/// By what is left to do, as far as rounds foretell it: 4 for each primitive. 64 pixels take 256 at
/// first, and no round of the last case takes 1200.
TEST(LightGrids, AreBuiltWherePicturesByErrorTakeManySamples) {
  struct Case {
    int spheres;
    double error;
    int grids;
  };
  for (const Case& c : {Case{100, .3, 0}, Case{300, .1, 0}, Case{300, .01, 1}}) {
    Scene scene = random_spheres(5, c.spheres);
    scene.lights.push_back({{3, 4, 5}, {1, 1, 1}});
    const World world(scene, {});
    RenderOptions options;
    RenderStats stats;
    options.refine.error = c.error;
    options.point_grids = PointGrids::kOff;
    const Image wanted = render(world, camera_of(8), options, stats);
    EXPECT_EQ(stats.point_grids.count, 0);
    options.point_grids = PointGrids::kAuto;
    EXPECT_EQ(render(world, camera_of(8), options, stats).rgb, wanted.rgb);
    EXPECT_EQ(stats.point_grids.count, c.grids) << c.spheres << ' ' << c.error;
  }
}

/// A walk among few primitives takes less than a look-up.
TEST(LightGrids, AreNotBuiltForFew) {
  for (const int count : {20, 60}) {
    Scene scene = random_spheres(5, count);
    scene.lights.push_back({{3, 4, 5}, {1, 1, 1}});
    const World world(scene, {});
    ASSERT_FALSE(world.grids().empty());
    RenderStats stats;
    render(world, camera_of(96), {}, stats);
    EXPECT_EQ(stats.point_grids.count, count < 32 ? 0 : 1) << count;
  }
}

TEST(LightGrids, AreNoneInDouble) {
  const Scene scene = lit_from_everywhere();
  const World world(scene, {});
  RenderOptions options;
  options.precision = Precision::kDouble;
  options.point_grids = PointGrids::kOn;
  RenderStats stats;
  render(world, camera_of(32), options, stats);
  EXPECT_EQ(stats.point_grids.count, 0);
}

Scene lit_mixture() {
  Scene s = random_mixture(31, 4000);
  for (const Float3& at : {Float3{0, 9, 0}, Float3{4, 3, 1}, Float3{-5, 2, 2}})
    s.lights.push_back({at, {.3f, .3f, .3f}});
  return s;
}

TEST(LightGrids, LeaveOutWhatFindsNoRoom) {
  const Scene scene = lit_mixture();
  const World any(scene, {});
  RenderOptions options;
  options.point_grids = PointGrids::kOn;
  RenderStats stats;
  const Image wanted = render(any, camera_of(32), options, stats);
  const int all = stats.point_grids.count;
  ASSERT_GE(all, 3);
  const std::size_t of_one = stats.point_grids.bytes / static_cast<std::size_t>(all);
  // 256 bytes a primitive are counted on
  const World some(scene, {.most_bytes = any.grid_bytes() + of_one + 5000 * 256});
  EXPECT_EQ(render(some, camera_of(32), options, stats).rgb, wanted.rgb);
  EXPECT_GT(stats.point_grids.count, 0);
  EXPECT_LT(stats.point_grids.count, all);
  EXPECT_LE(any.grid_bytes() + stats.point_grids.bytes, any.grid_bytes() + of_one + 5000 * 256);
  const World none(scene, {.most_bytes = World::estimate(scene, {}).peak + 1000});
  EXPECT_EQ(render(none, camera_of(32), options, stats).rgb, wanted.rgb);
  EXPECT_EQ(stats.point_grids.count, 0);
}

TEST(LightGrids, AreEstimatedBeforeTheyAreBuilt) {
  const Scene scene = lit_mixture();
  const std::uint64_t expected = World::estimate(scene, {}).lights;
  RenderOptions options;
  options.point_grids = PointGrids::kOn;
  RenderStats stats;
  render(World(scene, {}), camera_of(16), options, stats);
  EXPECT_GT(expected, stats.point_grids.bytes / 3);
  EXPECT_LT(expected, stats.point_grids.bytes * 3);
  Scene area = scene;
  for (Light& light : area.lights)
    light.edge1 = light.edge2 = {1, 0, 1};
  EXPECT_EQ(World::estimate(area, {}).lights, 0u);
}

}  // namespace
}  // namespace grelha::test
