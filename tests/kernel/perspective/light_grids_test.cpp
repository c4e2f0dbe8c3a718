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

}  // namespace
}  // namespace grelha::test
