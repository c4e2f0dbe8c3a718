// A fifth kind of primitive, in the kernel that has one: discs are hit where they are, by every way
// of tracing, and what else is asked of a kind holds for them.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numeric>

#include "grelha/grelha.hpp"
#include "kernel/world/world_impl.hpp"
#include "kernel/shapes/primitives.hpp"
#include "tests/support/one_hit.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/random.hpp"

namespace grelha {
namespace {

using test::Random;
using test::oracle::Real;
using test::oracle::V;

/// Discs among spheres, over a plane.
Scene mixture(int discs) {
  Random random(7);
  Scene s;
  s.materials.resize(2);
  s.materials[0].diffuse = {.7f, .6f, .5f};
  s.materials[1].mirror = {.8f, .8f, .8f};
  s.lights.push_back({{5, 9, 7}, {1, 1, 1}});
  s.geometry.planes.add({0, -2, 0}, {0, 1, 0}, 0);
  for (int i = 0; i < discs; ++i) {
    const float radius = .05f + .1f * static_cast<float>(random.unit());
    s.geometry.discs.add(random.point(1), random.direction(), radius, i % 3 == 0 ? 1u : 0u);
    if (i % 4 == 0)
      s.geometry.spheres.add(random.point(1), radius / 2, 0);
  }
  return s;
}

Camera camera() {
  Camera c;
  c.eye = {.5f, 1, 4};
  c.width = c.height = 64;
  c.angle_deg = 40;
  return c;
}

TEST(Disc, IsMetWhereItIs) {
  Random random(1);
  int met = 0, missed = 0;
  for (int i = 0; i < 200000; ++i) {
    const double size = random.log_in(1e-6, 1e6);
    const Float3 c = random.point(size), o = random.point(size * random.log_in(1, 1e3));
    const Float3 n = random.direction(), aside = random.direction();
    const float r = static_cast<float>(size * random.log_in(.01, 1));
    const float away = r * static_cast<float>(2 * random.unit());
    const Float3 d = {
        c.x + away * aside.x - o.x, c.y + away * aside.y - o.y, c.z + away * aside.z - o.z};
    const V org = o, dir = d, normal = n, center = c;
    const Real cosine = std::abs(dot(dir, normal)) / (length(dir) * length(normal));
    if (cosine < .01L)
      continue;  // from here on the bound's first order is all there is
    const Real t_true = dot(center - org, normal) / dot(dir, normal);
    const Real from_rim = length(org + t_true * dir - center) - r;
    const Real bound = test::oracle::kEps * length(center - org) / cosine;
    const auto [found, t] =
        test::one_hit<Disc>(test::exact_ray(o, d), {{c.x, c.y, c.z}, {n.x, n.y, n.z}, r});
    if (std::abs(from_rim) > 32 * bound) {
      ASSERT_EQ(found, from_rim < 0 && t_true > 0) << "case " << i;
    }
    if (found) {
      ASSERT_LE(std::abs(t - t_true) * length(dir), 16 * bound) << "case " << i;
    }
    ++(found ? met : missed);
  }
  EXPECT_GT(met, 50000);
  EXPECT_GT(missed, 50000);
}

TEST(Disc, MakesOnePictureHoweverItIsTraced) {
  const Scene scene = mixture(600);
  const World gridded(scene, {}), listed(scene, {.grid = false});
  ASSERT_GT(gridded.grids().size(), 0u);
  const auto picture = [&](const World& world, const char* isa, int packet) {
    RenderOptions options;
    options.isa = isa;
    options.packet = packet;
    RenderStats stats;
    return render(world, camera(), options, stats).rgb;
  };
  const auto plain = picture(listed, "scalar", 1);
  for (const char* isa : {"scalar", "best"})
    for (const int packet : {1, 16, 64, 256})
      EXPECT_EQ(picture(gridded, isa, packet), plain) << isa << ", packets of " << packet;
  int discs = 0;
  for (const Ray& ray : {Ray{{0, 0, 4}, {0, 0, -1}}, Ray{{0, 4, 0}, {0, -1, 0}}}) {
    const Hit hit = closest(gridded, ray);
    discs += hit.id != kNoPrimitive && primitive_of(gridded, hit.id).kind == PrimitiveKind::kDisc;
  }
  EXPECT_GT(discs, 0);
}

TEST(Disc, IsLeftByRaysThatStartOnIt) {
  const Scene scene = mixture(600);
  const World world(scene, {});
  Random random(3);
  int left = 0;
  for (int i = 0; i < 20000; ++i) {
    const Float3 o = random.point(4), to = random.point(.8);
    const Ray ray{o, {to.x - o.x, to.y - o.y, to.z - o.z}};
    const Hit hit = closest(world, ray);
    if (hit.id == kNoPrimitive || primitive_of(world, hit.id).kind != PrimitiveKind::kDisc)
      continue;
    const SurfacePoint at = surface(world, ray, hit);
    const Float3 d = random.direction();
    ASSERT_NE(closest(world, Ray{at.start(d), d}).id, hit.id) << "ray " << i;
    ++left;
  }
  EXPECT_GT(left, 1000);
}

TEST(Disc, IsACopyOfAnEqualOneAlone) {
  Geometry g;
  for (int i = 0; i < 30; ++i)
    g.discs.add({0, 0, 0}, {0, 0, 2}, i % 3 == 0 ? 1.f : 2.f, 0);
  const Primitives primitives(g);
  std::vector<std::uint32_t> ids(30);
  std::iota(ids.begin(), ids.end(), primitives.ids.begin(PrimitiveKind::kDisc));
  EXPECT_EQ(find_duplicates(primitives, ids).size(), 28u);
}

TEST(Disc, IsRefusedWhereArraysAreUneven) {
  Scene scene = mixture(3);
  scene.geometry.discs.radius.pop_back();
  EXPECT_THROW(World(scene, {}), std::invalid_argument);
}

}  // namespace
}  // namespace grelha
