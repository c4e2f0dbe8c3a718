// Insides of meshes, against rational numbers.
#include "grelha/inside.hpp"

#include <gtest/gtest.h>

#include "kernel/query/variants.hpp"
#include "tests/support/hard_meshes.hpp"
#include "tests/support/rational_winding.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

constexpr std::size_t kPoints = 400;  ///< a mesh

/// Adds the triangles of another mesh: moved, scaled, and with their corners in the other order.
void add_mesh(Scene& s, const Scene& other, const Float3& by, double scale = 1, bool turn = false) {
  const Triangles& t = other.geometry.triangles;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const auto corner = [&](std::uint32_t v) { return at(by, scale, vertex(other, v)); };
    add_triangle(s, corner(t.a[i]), corner(turn ? t.c[i] : t.b[i]), corner(turn ? t.b[i] : t.c[i]));
  }
}

/// Points in and around the box of a unit mesh, far away, on a lattice, and beside vertices.
std::vector<Float3> points_around(const Scene& s, std::uint64_t seed) {
  Random random(seed);
  std::vector<Float3> points;
  const auto vertices = static_cast<std::uint32_t>(s.geometry.triangles.vertex_count());
  for (std::size_t i = 0; i < kPoints; ++i) {
    const Float3 near = vertex(s, random.below(vertices));
    const Float3 on_lattice = scaled({static_cast<float>(random.below(17)) - 8,
                                      static_cast<float>(random.below(17)) - 8,
                                      static_cast<float>(random.below(17)) - 8},
                                     .125);
    switch (i % 4) {
      case 0:
        points.push_back(random.point(i % 16 == 0 ? 1e4 : 1.3));
        break;
      case 1:
        points.push_back(on_lattice);
        break;
      default:
        points.push_back(at(near, random.log_in(1e-7, .3), random.direction()));
    }
  }
  return points;
}

/// Closed meshes: plain, doubled, overlapping, turned inside out, nested, thin, beside spheres.
std::vector<Scene> closed_meshes() {
  std::vector<Scene> all = {ball_mesh(16, 8), torus_mesh(20, 12, .4)};
  all.push_back(with_copies(all[1]));
  Scene overlapping = empty_scene();
  add_mesh(overlapping, ball_mesh(14, 7), {-.25f, 0, 0}, .7);
  add_mesh(overlapping, torus_mesh(18, 10, .4), {.25f, .125f, 0}, .7);
  all.push_back(overlapping);
  Scene turned = empty_scene();
  add_mesh(turned, ball_mesh(14, 7), {}, 1, true);
  all.push_back(turned);
  Scene nested = empty_scene();  // 84 walls to one side
  for (int i = 0; i < 84; ++i)
    add_mesh(nested, ball_mesh(5, 3), {}, .2 + .01 * i, i % 3 == 0);
  all.push_back(nested);
  Scene thin = torus_mesh(24, 10, .4);
  for (float& y : thin.geometry.triangles.y)
    y *= 1e-5f;
  all.push_back(thin);
  return all;
}

TEST(Contains, IsTheParityOfRationalCrossings) {
  std::size_t judged = 0, within = 0;
  std::uint64_t seed = 0;
  for (const Scene& s : closed_meshes()) {
    const World world(s, {});
    const std::vector<Float3> points = points_around(s, ++seed);
    std::vector<std::uint8_t> inside(points.size());
    contains(world, points, inside, {.threads = 2});
    Random random(seed);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(inside[i] != 0, contains(world, points[i])) << "mesh " << seed << ", point " << i;
      const auto expected = rational::winding(s.geometry.triangles, points[i], random);
      if (!expected)
        continue;
      EXPECT_EQ(inside[i] != 0, *expected % 2 != 0) << "mesh " << seed << ", point " << i;
      ++judged;
      within += inside[i];
    }
  }
  EXPECT_GT(judged, 6 * kPoints);
  EXPECT_GT(within, kPoints);
}

/// More crossings on one side than a walk keeps, and more copies than a cell does.
TEST(Contains, CountsAnyNumberOfCrossings) {
  for (const int copies : {63, 64, 65, 1500, 1501}) {
    Scene s = empty_scene();
    for (int i = 0; i < copies; ++i)
      add_mesh(s, ball_mesh(4, 2), {});
    const World world(s, {});
    EXPECT_EQ(contains(world, {.1f, .05f, .02f}), copies % 2 == 1) << copies;
    EXPECT_FALSE(contains(world, {2, 1, 0})) << copies;
  }
}

TEST(Contains, IsTheSameByEveryInstructionSet) {
  std::uint64_t seed = 20;
  for (const Scene& s : closed_meshes()) {
    const World world(s, {});
    const std::vector<Float3> points = points_around(s, ++seed);
    std::vector<std::uint8_t> expected(points.size()), inside(points.size());
    contains(world, points, expected, {.isa = "scalar"});
    for (const Variant* variant : variants()) {
      if (!variant->is_supported())
        continue;
      contains(world, points, inside, {.isa = variant->name});
      EXPECT_EQ(inside, expected) << variant->name << ", mesh " << seed;
    }
  }
}

TEST(Contains, ReportsProgressAndStops) {
  const Scene s = torus_mesh(40, 20, .4);
  const World world(s, {});
  const std::vector<Float3> points(200000, {.5f, .5f, .5f});
  std::vector<std::uint8_t> inside(points.size());
  int calls = 0;
  EXPECT_THROW(
      contains(
          world, points, inside, {.threads = 2, .progress = [&](double) { return ++calls < 3; }}),
      Stopped);
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace grelha::test
