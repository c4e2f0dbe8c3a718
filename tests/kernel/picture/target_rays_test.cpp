// Tests the rays that target small objects.
#include "kernel/picture/target_rays.hpp"

#include <gtest/gtest.h>

#include "kernel/shade/pixel_box.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

constexpr int kSide = 16;  ///< pixels

/// Looks along -z at pixels one unit across at z = 0, whose corners are whole numbers.
Camera of_unit_pixels() {
  Camera c = straight_down(kSide, kSide, kSide / 1000.);
  c.eye = {0, 0, 1000};
  return c;
}

/// Returns the picture after the search, before any pixel is sampled.
Refinement searched(const Scene& scene, Camera camera = of_unit_pixels()) {
  const World world(scene, {});
  RenderOptions options;
  options.refine.error = .01;
  grelha::Setup setup = set_up(world, camera, options);
  Refinement r = make_refinement(camera);
  TraceCounts counts;
  target_small_objects(world.impl(), setup, 2, r, counts);
  return r;
}

/// The pixel over (x, y) at z = 0.
std::size_t pixel_of(double x, double y) {
  return static_cast<std::size_t>(std::floor(kSide / 2 - y) * kSide + std::floor(kSide / 2 + x));
}

std::size_t boxes(const Refinement& r) {
  return static_cast<std::size_t>(
      std::count_if(r.box.begin(), r.box.end(), [](std::uint32_t box) { return box != 0; }));
}

/// Checks that the box of the pixel contains a disc and is not much larger.
void expect_box(const Refinement& r, double x, double y, double radius) {
  const std::uint32_t word = r.box[pixel_of(x, y)];
  ASSERT_NE(word, 0u) << x << ' ' << y;
  const PixelBox box = unpacked(word);
  const double in_x = x - std::floor(x), in_y = 1 - (y - std::floor(y));
  EXPECT_LE(double{box.x0}, in_x - radius);
  EXPECT_GE(double{box.x1}, in_x + radius);
  EXPECT_LE(double{box.y0}, in_y - radius);
  EXPECT_GE(double{box.y1}, in_y + radius);
  EXPECT_LE(double{box.area()}, std::pow(2 * radius + .06, 2));
}

TEST(AimedRays, FindSpecks) {
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const double x = std::floor(random.in(-8, 8)) + random.in(.2, .8);
    const double y = std::floor(random.in(-8, 8)) + random.in(.2, .8);
    const Scene s = one_sphere({float(x), float(y), 0}, .1f);
    Camera parallel = of_unit_pixels();
    parallel.eye.z = 1;  // where a picture from a point would show other things
    parallel.orthographic_height = kSide;
    for (const Camera& camera : {of_unit_pixels(), parallel}) {
      const Refinement r = searched(s, camera);
      EXPECT_EQ(boxes(r), 1u);
      expect_box(r, x, y, .1);
      const std::size_t b = r.blocks().of_pixel(pixel_of(x, y));
      EXPECT_GT(r.missed[b], 1e-5f);
    }
  }
}

/// Objects wider than a pixel are left to the samples; objects behind the eye or a wall are
/// invisible; a pane hides nothing.
TEST(AimedRays, AreForWhatIsSeenAndThin) {
  EXPECT_EQ(boxes(searched(one_sphere({.5f, .5f, 0}, .6f))), 0u);
  EXPECT_EQ(boxes(searched(one_sphere({.5f, .5f, 2000}, .1f))), 0u);
  Scene s = one_sphere({.5f, .5f, 0}, .1f);
  s.geometry.planes.add({0, 0, 5}, {0, 0, 1}, 0);
  EXPECT_EQ(boxes(searched(s)), 0u);
  s.materials[0].transmission = .8f;
  expect_box(searched(s), .5, .5, .1);
}

TEST(AimedRays, FollowLongThings) {
  const Refinement cone = searched(one_cone({-7.5f, 2.5f, 0}, .05f, {7.5f, 2.5f, 0}, .05f));
  EXPECT_EQ(boxes(cone), 16u);
  for (double x = -7.5; x < 8; ++x)
    EXPECT_NE(cone.box[pixel_of(x, 2.5)], 0u) << x;
}

/// Objects out of focus get no box.
TEST(AimedRays, LeaveWhatIsOutOfFocus) {
  Camera c = of_unit_pixels();
  c.aperture = 50;
  c.focus = 1000;
  expect_box(searched(one_sphere({.5f, .5f, 0}, .1f), c), .5, .5, .1);
  EXPECT_EQ(boxes(searched(one_sphere({.5f, .5f, -100}, .1f), c)), 0u);
}

}  // namespace
}  // namespace grelha::test
