// A point lies inside a closed mesh or not, whatever ray is asked: through vertices, along edges,
// in the planes of triangles.
#include "grelha/all_hits.hpp"
#include "tests/support/closed.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

/// A cube of whole numbers with its faces cut into squares: rays along axes run along its edges.
Scene lattice_cube(int n) {
  Scene s = empty_scene();
  const auto corner = [n](int axis, int side, int u, int v) {
    Float3 p{};
    component(p, static_cast<std::uint32_t>(axis)) = static_cast<float>(side * n);
    component(p, static_cast<std::uint32_t>((axis + 1) % 3)) = static_cast<float>(u);
    component(p, static_cast<std::uint32_t>((axis + 2) % 3)) = static_cast<float>(v);
    return p;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int u = 0; u < n; ++u)
        for (int v = 0; v < n; ++v) {
          const auto at = [&](int i, int j) { return corner(axis, side, u + i, v + j); };
          add_triangle(s, at(0, 0), at(1, 0), at(1, 1));
          add_triangle(s, at(0, 0), at(1, 1), at(0, 1));
        }
  return s;
}

bool is_inside(const World& world, const Float3& from, const Float3& dir) {
  return count_crossings(world, {from, dir}) % 2 == 1;
}

/// Five random rays, one along each axis, and one to a vertex and one to the middle of an edge.
void expect_agreement(const World& world, const Scene& s, const Float3& from, Random& random) {
  const Triangles& t = s.geometry.triangles;
  const bool inside = is_inside(world, from, random.direction());
  const auto expect = [&](const Float3& dir) {
    EXPECT_EQ(is_inside(world, from, dir), inside)
        << from.x << ' ' << from.y << ' ' << from.z << " towards " << dir.x << ' ' << dir.y << ' '
        << dir.z;
  };
  for (int i = 0; i < 4; ++i)
    expect(random.direction());
  for (std::uint32_t a = 0; a < 3; ++a) {
    Float3 axis{};
    component(axis, a) = random.chance(.5) ? 1.f : -1.f;
    expect(axis);
  }
  const std::uint32_t k = random.below(static_cast<std::uint32_t>(t.a.size()));
  expect(minus(vertex(s, t.a[k]), from));
  expect(minus(at(vertex(s, t.a[k]), .5, minus(vertex(s, t.b[k]), vertex(s, t.a[k]))), from));
}

TEST(Crossings, TellInsideFromOutsideByAnyRay) {
  Random random(5);
  for (const Scene& s : {lattice_cube(4), ball_mesh(16, 8), torus_mesh(20, 12, kTube)})
    for (const float density : {0.f, .1f}) {
      const World world(s, {.density = density});
      const bool cube = s.geometry.triangles.a.size() == 192;
      for (int i = 0; i < 400 && !testing::Test::HasFailure(); ++i) {
        // whole and half numbers lie in planes and on lines of the cube, but on its faces
        const auto half = [&] { return .5f * static_cast<float>(random.below(7) + 1); };
        const bool far = random.chance(.2);
        const Float3 from = cube ? Float3{half(), half(), far ? half() + 7 : half()}
                                 : random.point(far ? 1e6 : 1.3);
        expect_agreement(world, s, from, random);
        if (cube) {
          EXPECT_EQ(is_inside(world, from, {0, 0, -1}), !far);
        }
      }
    }
}

TEST(Crossings, OfTrianglesBetweenTheEndsAlone) {
  Scene s = lattice_cube(1);
  s.geometry.spheres.add({.5f, .5f, .5f}, .1f, 0);
  const World world(s, {});
  const Float3 o{.25f, .5f, -1}, d{0, 0, 1};
  EXPECT_EQ(count_crossings(world, {o, d}), 2u);
  EXPECT_EQ(count_crossings(world, {o, d, 0, 2}), 1u);
  EXPECT_EQ(count_crossings(world, {o, d, 1, kInf}), 1u);
  EXPECT_EQ(count_crossings(world, {o, d, 0, 1}), 0u);
  EXPECT_EQ(count_crossings(world, {o, {0, 0, -1}}), 0u);
  EXPECT_EQ(count_crossings(world, {o, {0, 0, 0}}), 0u);
}

}  // namespace
}  // namespace grelha::test
