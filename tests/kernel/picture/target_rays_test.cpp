// Tests the rays that target small objects, and the connected components of meshes.
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
/// invisible.
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
  Scene strip = empty_scene();
  for (int i = 0; i < 8; ++i) {  // connected by their coordinates alone
    const float x = static_cast<float>(i - 4);
    add_triangle(strip, {x, .4f, 0}, {x + 1, .4f, 0}, {x, .5f, 0});
    add_triangle(strip, {x + 1, .4f, 0}, {x + 1, .5f, 0}, {x, .5f, 0});
  }
  const Refinement mesh = searched(strip);
  for (double x = -3.5; x < 4; ++x)
    EXPECT_NE(mesh.box[pixel_of(x, .45)], 0u) << x;
  EXPECT_LE(boxes(mesh), 10u);
}

/// A flat mirror shows a speck as far behind it as it lies before; the back of a wall hides it.
TEST(AimedRays, LookIntoFlatMirrors) {
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
  add_triangle(s, {2.3f, -2.9f, 95}, {2.3f, -8, 95}, {8, -2.9f, 95}, 0);
  EXPECT_EQ(boxes(searched(s)), 1u) << "a wall between mirror and speck";
}

/// A point light throws the shadow of a speck twice as far to the side as the speck.
TEST(AimedRays, FindShadows) {
  Scene s = one_sphere({40.25f, .25f, 10}, .05f);
  s.geometry.planes.add({0, 0, 0}, {0, 0, 1}, 0);
  s.lights = {{{77.f, .0f, 20}, {1, 1, 1}}};
  const Refinement r = searched(s);
  expect_box(r, 3.5, .5, .1);
  s.lights[0].edge1 = {1, 0, 0};
  s.lights[0].edge2 = {0, 1, 0};
  EXPECT_EQ(boxes(searched(s)), 0u) << "soft shadows are met by samples";
}

/// Objects out of focus get no box.
TEST(AimedRays, LeaveWhatIsOutOfFocus) {
  Camera c = of_unit_pixels();
  c.aperture = 50;
  c.focus = 1000;
  expect_box(searched(one_sphere({.5f, .5f, 0}, .1f), c), .5, .5, .1);
  EXPECT_EQ(boxes(searched(one_sphere({.5f, .5f, -100}, .1f), c)), 0u);
}

TEST(MeshParts, AreConnectedByIndexOrPlace) {
  Scene s = empty_scene();
  add_triangle(s, {0, 0, 0}, {3, 0, 0}, {3, .1f, 0});
  add_triangle(s, {3, 0, 0}, {6, 0, 0}, {6, .1f, 0});  // touches the first in a corner
  add_triangle(s, {0, 9, 0}, {1, 9, 0}, {0, 9, 2});
  Triangles& t = s.geometry.triangles;
  t.a.push_back(6);  // shares vertices of the third
  t.b.push_back(7);
  t.c.push_back(8);
  t.material.push_back(0);
  const std::vector<Capsule> rods = mesh_parts(TriangleSpans(t));
  ASSERT_EQ(rods.size(), 2u);
  EXPECT_NEAR(rods[0].length(), 6, .01);
  EXPECT_NEAR(rods[0].radius, .05, .06);
  EXPECT_NEAR(rods[1].length(), std::sqrt(5.), 1e-6);
  EXPECT_NEAR(rods[1].radius, 2 / std::sqrt(5.), 1e-6);
}

/// Of a piece of many triangles some are looked at.
TEST(MeshParts, OfManyTrianglesLieWhereTheyAll) {
  Scene s = empty_scene();
  Triangles& t = s.geometry.triangles;
  constexpr std::uint32_t kCount = 10000;
  for (std::uint32_t i = 0; i <= kCount; ++i)
    for (const float y : {0.f, 1.f}) {
      t.x.push_back(static_cast<float>(i));
      t.y.push_back(y);
      t.z.push_back(0);
    }
  for (std::uint32_t i = 0; i < 2 * kCount; ++i) {
    t.a.push_back(i);
    t.b.push_back(i + 1);
    t.c.push_back(i + 2);
    t.material.push_back(0);
  }
  const std::vector<Capsule> rods = mesh_parts(TriangleSpans(t));
  ASSERT_EQ(rods.size(), 1u);
  EXPECT_NEAR(rods[0].length(), kCount, 20);
  EXPECT_NEAR(rods[0].radius, 1, .01);
}

}  // namespace
}  // namespace grelha::test
