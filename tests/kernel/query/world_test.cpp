// Worlds of geometry alone, worlds whose vertices move, and points of surfaces without a ray.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "grelha/all_hits.hpp"
#include "grelha/distance.hpp"
#include "grelha/owning_world.hpp"
#include "kernel/world/world_impl.hpp"
#include "tests/support/brute_force.hpp"
#include "tests/support/random.hpp"
#include "tests/support/same_grids.hpp"
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

using Faces = std::vector<std::array<std::uint32_t, 3>>;
OffsetScene scene_of(const PointArray& points, const Faces& faces) {
  return grelha::scene_of(points, triangles_of<std::uint32_t>(faces, points.count));
}

TEST(OwningWorld, CopiesPointsOfAnyStride) {
  const struct {
    char tag;
    float at[3];
    char end;
  } points[2] = {{0, {1, 2, 3}, 0}, {0, {4, 5, 6}, 0}};
  const OffsetScene found = scene_of({points[0].at, sizeof points[0], 2, "points"}, {{0, 1, 0}});
  EXPECT_EQ(found.geometry.triangles.x, (std::vector<float>{1, 4}));
  EXPECT_EQ(found.geometry.triangles.y, (std::vector<float>{2, 5}));
  EXPECT_EQ(found.geometry.triangles.z, (std::vector<float>{3, 6}));
  EXPECT_EQ(found.geometry.triangles.b, (std::vector<std::uint32_t>{1}));
  EXPECT_EQ(found.offset, (std::array<double, 3>{}));
  const std::ptrdiff_t back = -static_cast<int>(sizeof points[0]);
  EXPECT_EQ(scene_of({points[1].at, back, 2, "points"}, {}).geometry.triangles.x,
            (std::vector<float>{4, 1}));
}

TEST(OwningWorld, KeepsTheDigitsOfSurveys) {
  // what no triangle names has no part in the offset
  const double points[] = {
      512345.125, 5412345.5, 81.0625, 512352.375, 5412349.75, 80.5, 1e300, NAN, 0};
  const OffsetScene found = scene_of({points, 24, 3, "points"}, {{0, 1, 0}});
  const Triangles& t = found.geometry.triangles;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(t.x[i] + found.offset[0], points[3 * i]);
    EXPECT_EQ(t.y[i] + found.offset[1], points[3 * i + 1]);
    EXPECT_EQ(t.z[i] + found.offset[2], points[3 * i + 2]);
  }
  EXPECT_NE(found.offset[1], 0);
  const auto offset_of = [](const double* of, std::size_t count) {
    return scene_of({of, 24, count, "points"}, {{0, static_cast<std::uint32_t>(count) - 1, 0}})
        .offset;
  };
  // near the origin floats resolve a millionth of the size, whether they are exact or not
  const double near[] = {.1, 7, -3, .2, 9, -3};
  EXPECT_EQ(offset_of(near, 2), (std::array<double, 3>{}));
  const double far[] = {.1, 9, -3, .2, 11, -3};
  EXPECT_EQ(offset_of(far, 2), (std::array<double, 3>{0, 8, -4}));
  const float floats[] = {1e6f, 0, 0, 1e6f + 1, 0, 0};
  EXPECT_EQ(scene_of({floats, 12, 2, "points"}, {{0, 1, 0}}).offset, (std::array<double, 3>{}));
  const double same[] = {1e17 + 16, .1, 0};
  EXPECT_NEAR(offset_of(same, 1)[0], 1e17, 1e9);
  EXPECT_EQ(PointBounds().offset(), (std::array<double, 3>{}));
}

/// What a call throws.
template <class Error, class Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing";
}

TEST(OwningWorld, SaysWhichNumberIsBad) {
  const float points[] = {0, 0, 0, 1, 0, 0, 0, INFINITY, 0};
  const PointArray three(points, 12, 3, "vertices");
  EXPECT_EQ(error_of<BadNumber>([&] {
              scene_of(three, {{0, 1, 1}, {0, 3, 1}});
            }),
            "indices: expected numbers below 3, found 3 in triangle 1");
  const std::array<std::int64_t, 3> negative[] = {{0, 1, -1}};
  EXPECT_THROW(triangles_of<std::int64_t>(negative, 3), BadNumber);
  EXPECT_EQ(error_of<BadNumber>([&] {
              scene_of(three, {{0, 1, 2}});
            }),
            "vertices: expected finite numbers within 1e18, found inf in element 2");
  const double radii[] = {1, 1e-60};
  EXPECT_EQ(error_of<BadNumber>([&] { spheres_of<double>(radii); }),
            "radii: expected numbers above 0 and within 1e18, found 0.000000 in element 1");
  const auto one = spheres_of<double>({radii, 1});
  EXPECT_THROW(grelha::scene_of(three, one), std::invalid_argument);
  EXPECT_THROW(grelha::scene_of(three, random_mixture(1, 20).geometry), std::invalid_argument);
  Geometry both = spheres_of<float>(std::array{1.f});
  both.triangles.a = both.triangles.b = both.triangles.c = {0};
  EXPECT_THROW(grelha::scene_of({points, 12, 1, "points"}, both), std::invalid_argument);
  Geometry beyond;
  beyond.triangles.a = beyond.triangles.b = beyond.triangles.c = {3};
  EXPECT_THROW(grelha::scene_of(three, beyond), std::invalid_argument);
  EXPECT_THROW(PointArray(points, 0, 1, "points"), std::invalid_argument);
  EXPECT_THROW(PointArray(static_cast<const float*>(nullptr), 12, 1, "points"),
               std::invalid_argument);
}

TEST(OwningWorld, MovesOrStaysAsItWas) {
  const double corners[] = {1e7, 0, 0, 1e7 + 1, 0, 0, 1e7, 1, 0};
  const double higher[] = {1e7, 0, 2, 1e7 + 1, 0, 2, 1e7, 1, 2};
  OwningWorld world(scene_of({corners, 24, 3, "points"}, {{0, 1, 2}}), {});
  const std::array<double, 3> offset = world.scene().offset;
  const Ray down{{static_cast<float>(1e7 + .25 - offset[0]), .25f, 9}, {0, 0, -1}};
  world.move({higher, 24, 3, "points"}, {});
  EXPECT_EQ(world.scene().offset, offset);
  EXPECT_EQ(closest(world.world(), down).t, 7);
  const PointArray back(corners, 24, 3, "points");
  EXPECT_EQ(error_of<std::invalid_argument>([&] {
              world.move({corners, 24, 2, "points"}, {});
            }),
            "count: expected as many points as before, 3, found 2");
  EXPECT_THROW(world.move(back, {.threads = -1}), std::invalid_argument);
  EXPECT_THROW(world.move(back, {.progress = [](double) { return false; }}), Stopped);
  EXPECT_EQ(closest(world.world(), down).t, 7);
  EXPECT_EQ(world.scene().geometry.triangles.z, (std::vector<float>(3, 2)));
  // floats count from the offset
  const Float3 local[] = {{0, 0, 3}, {1, 0, 3}, {0, 1, 3}};
  world.move(PointArray(local), {});
  EXPECT_EQ(closest(world.world(), {{.25f, .25f, 9}, {0, 0, -1}}).t, 6);
  const OwningWorld elsewhere = std::move(world);
  EXPECT_EQ(closest(elsewhere.world(), {{.25f, .25f, 9}, {0, 0, -1}}).t, 6);
}

TEST(OwningWorld, HasAMaskForEachPrimitiveOrNone) {
  const Float3 centers[] = {{0, 0, 0}, {0, 0, 3}};
  const float radii[] = {1, 1};
  OwningWorld world(grelha::scene_of(PointArray(centers), spheres_of<float>(radii)), {});
  const std::uint8_t masks[] = {1, 0, 1};
  world.set_masks({masks, 2});
  EXPECT_EQ(world.masks().size(), 2u);
  EXPECT_EQ(error_of<std::invalid_argument>([&] { world.set_masks(masks); }),
            "count: expected 0 or 2, found 3");
  EXPECT_EQ(world.masks()[1], 0);
  world.set_masks({});
  EXPECT_TRUE(world.masks().empty());
}

/// The coordinates of a kind that move.
using Axes = std::vector<std::vector<float>*>;

/// Moves the coordinates a hundred times. A world that is updated has the grids of a new one and
/// answers as it does, bit for bit.
void expect_updates(Scene& s, const Axes& axes) {
  World world(s, {});
  Random random(4);
  for (int step = 0; step < 100; ++step) {
    for (std::vector<float>* const axis : axes)
      for (float& at : *axis)
        at += static_cast<float>(random.in(-.1, .1));
    world.update(s, {});
    const World fresh(s, {});
    ASSERT_TRUE(same_grids(world, fresh));
    for (int i = 0; i < 50; ++i) {
      const Ray ray{random.point(2), random.direction()};
      const Hit a = closest(world, ray), b = closest(fresh, ray);
      ASSERT_EQ(a.id, b.id);
      ASSERT_EQ(a.t, b.t);
    }
  }
}

TEST(Update, OfEachKindIsANewWorldBitForBit) {
  Scene s = random_mixture(3, 400);
  Geometry& g = s.geometry;
  expect_updates(s, {&g.triangles.x, &g.triangles.y, &g.triangles.z});
  expect_updates(s, {&g.spheres.x, &g.spheres.y, &g.spheres.z});
  expect_updates(s, {&g.cones.base_x, &g.cones.base_y, &g.cones.apex_z, &g.cones.apex_x});
  expect_updates(s, {&g.planes.x, &g.planes.y, &g.planes.z});
  expect_updates(s, {&g.triangles.y, &g.spheres.x, &g.cones.apex_z, &g.planes.z});
}

/// Vertices that leave the box of the grid, meet in one point, and come back.
TEST(Update, OfMeshesThatCollapseAndReturn) {
  Scene s = balls_and_triangles(11, 300);
  const std::vector<float> rest = s.geometry.triangles.x;
  World world(s, {});
  for (const float by : {100.f, 0.f, 1e-20f, 1e6f, 1.f}) {
    for (std::size_t i = 0; i < rest.size(); ++i)
      s.geometry.triangles.x[i] = by * rest[i];
    world.update(s, {});
    EXPECT_TRUE(same_grids(world, World(s, {}))) << by;
  }
}

/// Meshes of their own grids within a box that stays; two are too small for that.
Scene meshes_in_a_box() {
  Scene s = empty_scene();
  add_triangle(s, {-9, -9, -9}, {9, -9, -9}, {9, 9, 9});
  for (int i = 0; i < 6; ++i) {
    const Scene mesh = ball_mesh(i < 4 ? 24 : 6, i < 4 ? 12 : 4, .1, static_cast<std::uint64_t>(i));
    add_object(s, mesh);
    for (std::size_t v = s.geometry.triangles.x.size() - 3 * mesh.geometry.triangles.size();
         v < s.geometry.triangles.x.size();
         ++v)
      s.geometry.triangles.x[v] += static_cast<float>(2 * i - 5);
  }
  return s;
}

/// The blocks of each grid, where they lie in memory.
std::vector<const void*> stores(const World& world) {
  std::vector<const void*> all;
  for (int i = 0; i < world.impl().view.grid_count; ++i)
    all.push_back(world.impl().view.grids[i].lists.of<Triangle>().blocks);
  return all;
}

TEST(Update, OfOneObjectBuildsItsGridAlone) {
  Scene s = meshes_in_a_box();
  World world(s, {});
  Random random(8);
  std::size_t shared = 0;
  for (int step = 0; step < 40; ++step) {
    const Object moved = s.geometry.objects[random.below(6)];
    const bool leaves = step % 10 == 9;  // the box of the scene, and all grids are built
    for (std::uint32_t v = 3 * moved.first_triangle;
         v < 3 * (moved.first_triangle + moved.triangle_count);
         ++v)
      s.geometry.triangles.y[v] += leaves ? 20.f : .01f * static_cast<float>(random.below(20));
    const std::vector<const void*> before = stores(world);
    world.update(s, {}, {&moved, 1});
    EXPECT_TRUE(same_grids(world, World(s, {}))) << step;
    const std::vector<const void*> after = stores(world);
    ASSERT_EQ(before.size(), after.size());
    std::size_t kept = 0;
    for (std::size_t i = 0; i < after.size(); ++i)
      kept += before[i] == after[i];
    EXPECT_LT(kept, after.size());
    shared += kept;
  }
  EXPECT_GT(shared, 60u);
}

/// The World before goes on answering for its own arrays, and may go.
TEST(Update, IntoAnotherWorldSharesGridsWithOneThatMayGo) {
  const Scene before = meshes_in_a_box();
  Scene after = before;
  const Object moved = before.geometry.objects[2];
  for (std::uint32_t v = 3 * moved.first_triangle;
       v < 3 * (moved.first_triangle + moved.triangle_count);
       ++v)
    after.geometry.triangles.y[v] += .1f;
  auto first = std::make_unique<World>(before, BuildOptions{});
  const World second(after, {}, *first, {&moved, 1});
  EXPECT_TRUE(same_grids(*first, World(before, {})));
  std::size_t kept = 0;
  for (int i = 0; i < second.impl().view.grid_count; ++i)
    kept += stores(*first)[i] == stores(second)[i];
  EXPECT_EQ(kept, second.grids().size() - 1);
  first.reset();
  EXPECT_TRUE(same_grids(second, World(after, {})));
}

TEST(Update, OfObjectsBuildsAllWhereIdsChange) {
  Scene s = meshes_in_a_box();
  World world(s, {});
  s.geometry.spheres.add({0, 0, 0}, 1, 0);
  world.update(s, {}, {});
  EXPECT_TRUE(same_grids(world, World(s, {})));
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
    for (const Hit& hit : all_hits(world, {at.start(to), to}))
      ASSERT_NE(hit.id, id) << "kind " << static_cast<int>(primitive.kind) << " ray " << i;
  }
  EXPECT_THROW(surface_at(world, count, {}), std::invalid_argument);
}

TEST(SurfaceAt, OfABallThatShowsItsInsideIsWhereThePointIs) {
  Scene s = empty_scene();
  s.geometry.spheres.add({1, 2, 3}, -2, 0);
  s.geometry.spheres.add({1, 2, 3}, 2, 0);
  const World world(s, {});
  for (const std::uint32_t id : {0u, 1u}) {
    EXPECT_NEAR(surface_at(world, id, {9, 2, 3}).point.x, 3, 1e-6);
    EXPECT_NEAR(surface_at(world, id, {9, 2, 3}).normal.x, 1, 1e-6);
  }
  const SurfacePoint at = surface_at(world, 0, {9, 2, 3});
  const Float3 inwards{-1, 0, 0};
  EXPECT_NEAR(closest(world, Ray{at.start(inwards), inwards}).t, 4, 1e-5);
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
