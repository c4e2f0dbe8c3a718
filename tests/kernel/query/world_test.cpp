// Worlds of geometry alone, worlds whose vertices move, and points of surfaces without a ray.
#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

#include "grelha/all_hits.hpp"
#include "grelha/coordinates.hpp"
#include "grelha/distance.hpp"
#include "tests/support/brute_force.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

TEST(Geometry, NeedsNoMaterial) {
  Scene s = random_mixture(1, 200);
  const World with(s, {});
  SceneSpans bare(s);
  bare.materials = {};
  bare.geometry.planes.material = {};
  bare.geometry.spheres.material = {};
  bare.geometry.triangles.material = {};
  bare.geometry.cones.material = {};
  const World without(bare, {});
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const Ray ray{random.point(2), random.direction()};
    const Hit hit = closest(without, ray);
    ASSERT_EQ(hit.id, closest(with, ray).id);
    ASSERT_EQ(hit.t, closest(with, ray).t);
    if (hit) {
      EXPECT_EQ(surface(without, ray, hit).material, 0u);
    }
  }
  bare.geometry.cones.base_x = bare.geometry.cones.base_x.subspan(1);
  EXPECT_THROW(World(bare, {}), std::invalid_argument);
}

TEST(Coordinates, OfAnyStrideAreTheCallers) {
  const struct {
    char tag;
    float at[3];
    char end;
  } points[2] = {{0, {1, 2, 3}, 0}, {0, {4, 5, 6}, 0}};
  const Coordinates found = coordinates_of(points[0].at, sizeof points[0], 2);
  EXPECT_EQ(found.x, (std::vector<float>{1, 4}));
  EXPECT_EQ(found.y, (std::vector<float>{2, 5}));
  EXPECT_EQ(found.z, (std::vector<float>{3, 6}));
  EXPECT_EQ(found.offset, (std::array<double, 3>{}));
  const Coordinates back = coordinates_of(points[1].at, -static_cast<int>(sizeof points[0]), 2);
  EXPECT_EQ(back.x, (std::vector<float>{4, 1}));
  EXPECT_THROW(coordinates_of(static_cast<const float*>(nullptr), 12, 1), std::invalid_argument);
}

TEST(Coordinates, OfSurveysKeepTheirDigits) {
  const double points[] = {512345.125, 5412345.5, 81.0625, 512352.375, 5412349.75, 80.5};
  const Coordinates found = coordinates_of(points, 3 * sizeof(double), 2);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(found.x[i] + found.offset[0], points[3 * i]);
    EXPECT_EQ(found.y[i] + found.offset[1], points[3 * i + 1]);
    EXPECT_EQ(found.z[i] + found.offset[2], points[3 * i + 2]);
  }
  EXPECT_NE(found.offset[1], 0);
  const double small[] = {.5, 0, -3};
  EXPECT_EQ(coordinates_of(small, 24, 1).offset, (std::array<double, 3>{}));
  const double same[] = {1e17 + 16, .1, 0};
  EXPECT_NEAR(coordinates_of(same, 24, 1).offset[0], 1e17, 1e9);
}

TEST(Update, IsANewWorldBitForBit) {
  Scene s = random_mixture(3, 400);
  World world(s, {});
  Random random(4);
  Geometry& g = s.geometry;
  for (int step = 0; step < 100; ++step) {
    for (auto* axis : {&g.triangles.x, &g.spheres.y, &g.cones.apex_z, &g.planes.x})
      for (float& at : *axis)
        at += static_cast<float>(random.in(-.1, .1));
    world.update(s, {});
    const World fresh(s, {});
    for (int i = 0; i < 200; ++i) {
      const Ray ray{random.point(2), random.direction()};
      const Hit a = closest(world, ray), b = closest(fresh, ray);
      ASSERT_EQ(a.id, b.id);
      ASSERT_EQ(a.t, b.t);
    }
  }
}

TEST(Update, LeavesTheWorldWhereItThrows) {
  Scene s = one_sphere({0, 0, 0}, 1);
  World world(s, {});
  Scene broken = s;
  broken.geometry.spheres.y.clear();
  EXPECT_THROW(world.update(broken, {}), std::invalid_argument);
  EXPECT_TRUE(closest(world, {{0, 0, 5}, {0, 0, -1}}));
}

/// Rays that leave a point of a primitive to both sides never hit it again.
TEST(SurfaceAt, LetsRaysLeave) {
  const Scene s = random_mixture(5, 240);
  const World world(s, {});
  Random random(6);
  const auto count =
      static_cast<std::uint32_t>(s.geometry.planes.size() + s.geometry.spheres.size() +
                                 s.geometry.triangles.size() + s.geometry.cones.size());
  for (int i = 0; i < 20000; ++i) {
    const std::uint32_t id = random.below(count);
    const Float3 p = random.point(1.5);
    const SurfacePoint at = surface_at(world, id, p);
    const oracle::V n = brute::v(at.normal);
    EXPECT_NEAR(static_cast<double>(length(n)), 1, 1e-6);
    const Float3 to = random.direction();
    if (std::abs(static_cast<double>(dot(n, brute::v(to)))) < .05)
      continue;
    const Primitive primitive = primitive_of(world, id);
    const bool leaves_a_ball = dot(n, brute::v(to)) > 0;
    // what goes into a ball or a cone leaves it on the other side
    if ((primitive.kind == PrimitiveKind::kSphere || primitive.kind == PrimitiveKind::kCone) &&
        !leaves_a_ball)
      continue;
    if (primitive.kind == PrimitiveKind::kSphere && s.geometry.spheres.radius[primitive.index] < 0)
      continue;
    for (const Hit& hit : all_hits(world, {at.offset_origin(to), to}))
      ASSERT_NE(hit.id, id) << "kind " << static_cast<int>(primitive.kind) << " ray " << i;
  }
  EXPECT_THROW(surface_at(world, count, {}), std::invalid_argument);
}

TEST(SurfaceAt, IsTheClosestPointOfItsPrimitive) {
  const Scene s = balls_and_triangles(7, 150);
  const World world(s, {});
  Random random(8);
  for (int i = 0; i < 3000; ++i) {
    const Float3 p = random.point(1.5);
    const ClosestPoint closest = closest_point(world, p);
    const SurfacePoint at = surface_at(world, closest.id, p);
    EXPECT_LT(length(brute::v(at.point) - brute::v(closest.point)), 2e-5L) << i;
  }
}

TEST(Surfaces, AreThoseOfEachHit) {
  const Scene s = random_mixture(9, 200);
  const World world(s, {});
  Random random(10);
  std::vector<Ray> rays(6000);
  for (Ray& ray : rays)
    ray = {random.point(2), random.direction()};
  std::vector<Hit> hits(rays.size());
  closest(world, rays, hits);
  std::vector<SurfacePoint> points(rays.size());
  surfaces(world, rays, hits, points, {.threads = 2});
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!hits[i]) {
      EXPECT_TRUE(std::isnan(points[i].point.x));
      continue;
    }
    const SurfacePoint one = surface(world, rays[i], hits[i]);
    EXPECT_EQ(one.point, points[i].point);
    EXPECT_EQ(one.normal, points[i].normal);
  }
}

}  // namespace
}  // namespace grelha::test
