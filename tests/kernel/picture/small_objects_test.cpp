// Tests the boxes of objects that look thinner than a pixel.
#include "kernel/picture/sampling_round.hpp"

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
  mark_small_objects(world.impl(), setup.frame, r);
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

TEST(SmallObjects, FindSpecks) {
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

/// Objects wider than a pixel are left to the samples; objects behind the eye are invisible.
TEST(SmallObjects, LookThin) {
  EXPECT_EQ(boxes(searched(one_sphere({.5f, .5f, 0}, .6f))), 0u);
  EXPECT_EQ(boxes(searched(one_sphere({.5f, .5f, 2000}, .1f))), 0u);
  EXPECT_EQ(boxes(searched(one_sphere({.5f, 1e18f, 0}, .1f))), 0u);
}

/// Pixels with objects in all corners need no box.
TEST(SmallObjects, ShareABoxThatIsSmall) {
  Scene s = one_sphere({.2f, .2f, 0}, .1f);
  s.geometry.spheres.add({.45f, .45f, 0}, .1f, 0);
  EXPECT_EQ(boxes(searched(s)), 1u);
  s.geometry.spheres.add({.8f, .8f, 0}, .1f, 0);
  s.geometry.spheres.add({.2f, .2f, 0}, .1f, 0);
  EXPECT_EQ(boxes(searched(s)), 0u);
}

TEST(SmallObjects, FollowLongThings) {
  const Refinement cone = searched(one_cone({-7.5f, 2.5f, 0}, .05f, {7.5f, 2.5f, 0}, .05f));
  EXPECT_EQ(boxes(cone), 16u);
  for (double x = -7.5; x < 8; ++x)
    EXPECT_NE(cone.box[pixel_of(x, 2.5)], 0u) << x;
}

/// A disc of triangles is an object, a triangle within a surface is none.
TEST(SmallObjects, MayBeMeshes) {
  Scene s = empty_scene();
  Triangles& t = s.geometry.triangles;
  const auto add_vertex = [&](double x, double y) {
    t.x.push_back(static_cast<float>(x));
    t.y.push_back(static_cast<float>(y));
    t.z.push_back(0);
  };
  const auto add_face = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    t.a.push_back(a);
    t.b.push_back(b);
    t.c.push_back(c);
    t.material.push_back(0);
  };
  constexpr std::uint32_t kCorners = 12;
  for (std::uint32_t i = 0; i < kCorners; ++i)
    add_vertex(.5 + .1 * std::cos(.5236 * i), .5 + .1 * std::sin(.5236 * i));
  for (std::uint32_t i = 2; i < kCorners; ++i)
    add_face(0, i - 1, i);
  const Refinement disc = searched(s);
  EXPECT_EQ(boxes(disc), 1u);
  EXPECT_NE(disc.box[pixel_of(.5, .5)], 0u);
  constexpr std::uint32_t kGrid = 40;  // half a pixel apart, beyond the picture on all sides
  t = {};
  for (std::uint32_t i = 0; i < kGrid * kGrid; ++i)
    add_vertex(.5 * (i % kGrid) - 9.9, .5 * (i / kGrid) - 9.9);
  for (std::uint32_t i = 0; i + kGrid + 1 < kGrid * kGrid; ++i) {
    if (i % kGrid == kGrid - 1)
      continue;
    add_face(i, i + 1, i + kGrid);
    add_face(i + 1, i + kGrid + 1, i + kGrid);
  }
  EXPECT_EQ(boxes(searched(s)), 0u);
}

/// A flat mirror shows a speck as far behind it as it lies before.
TEST(SmallObjects, ShowInFlatMirrors) {
  Scene s = one_sphere({2.5f, -3.15f, 100}, .1f);
  s.materials.emplace_back().mirror = {.9f, .9f, .9f};
  add_triangle(s, {-8, -8, 0}, {8, -8, 0}, {8, 8, 0}, 1);
  add_triangle(s, {-8, -8, 0}, {8, 8, 0}, {-8, 8, 0}, 1);
  const double nearer = 1000. / 1100, direct = 1000. / 900;
  const Refinement r = searched(s);
  EXPECT_EQ(boxes(r), 2u);
  expect_box(r, 2.5 * nearer, -3.15 * nearer, .1 * nearer);
  expect_box(r, 2.5 * direct, -3.15 * direct, .1 * direct);
  s.materials[1].roughness = .1f;
  EXPECT_EQ(boxes(searched(s)), 1u) << "rough mirrors blur it";
  s.materials[1].roughness = 0;
  s.geometry.spheres.z[0] = -100;
  EXPECT_EQ(boxes(searched(s)), 1u) << "behind the mirror";
}

/// Objects out of focus get no box.
TEST(SmallObjects, LeaveWhatIsOutOfFocus) {
  Camera c = of_unit_pixels();
  c.aperture = 50;
  c.focus = 1000;
  expect_box(searched(one_sphere({.5f, .5f, 0}, .1f), c), .5, .5, .1);
  EXPECT_EQ(boxes(searched(one_sphere({.5f, .5f, -100}, .1f), c)), 0u);
}

}  // namespace
}  // namespace grelha::test
