#pragma once
// Meshes and points whose insides are hard to tell.

#include <vector>

#include "tests/support/hard_meshes.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {

/// Adds the triangles of another mesh: moved, scaled, and with their corners in the other order.
inline void add_mesh(
    Scene& s, const Scene& other, const Float3& by, double scale = 1, bool turn = false) {
  const Triangles& t = other.geometry.triangles;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const auto corner = [&](std::uint32_t v) { return at(by, scale, vertex(other, v)); };
    add_triangle(s, corner(t.a[i]), corner(turn ? t.c[i] : t.b[i]), corner(turn ? t.b[i] : t.c[i]));
  }
}

/// Points in and around the box of a unit mesh, far away, on a lattice, beside 0, and beside
/// vertices.
inline std::vector<Float3> points_around(const Scene& s, std::uint64_t seed, std::size_t count) {
  Random random(seed);
  std::vector<Float3> points;
  const auto vertices = static_cast<std::uint32_t>(s.geometry.triangles.vertex_count());
  for (std::size_t i = 0; i < count; ++i) {
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
        points.push_back(i % 8 == 1 ? on_lattice
                                    : Float3{on_lattice.x == 0 ? -0x1p-149f : on_lattice.x,
                                             on_lattice.y == 0 ? 0x1p-147f : on_lattice.y,
                                             on_lattice.z == 0 ? -0x1p-146f : on_lattice.z});
        break;
      default:
        points.push_back(at(near, random.log_in(1e-7, .3), random.direction()));
    }
  }
  return points;
}

/// Closed meshes: plain, doubled, overlapping, turned inside out, nested, thin, beside spheres.
inline std::vector<Scene> closed_meshes() {
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

/// Closed meshes that have points in their planes: a cube, and a plate whose sides are needles.
inline std::vector<Scene> flat_sided_meshes() {
  std::vector<Scene> all = {cube_at_zero(3), cube_at_zero(2)};
  for (float& z : all[1].geometry.triangles.z)
    z *= 1e-6f;
  return all;
}

/// Without some of their triangles, at one side or everywhere; and loose triangles.
inline std::vector<Scene> open_meshes() {
  std::vector<Scene> all;
  for (const Scene& from : {ball_mesh(24, 12, .05), torus_mesh(30, 20, .4)})
    for (const bool at_one_side : {false, true}) {
      Random random(7);
      Scene s = empty_scene();
      const Triangles& t = from.geometry.triangles;
      for (std::size_t i = 0; i < t.size(); ++i)
        if (at_one_side ? t.x[t.a[i]] < .6f : random.chance(.8))
          add_triangle(s, vertex(from, t.a[i]), vertex(from, t.b[i]), vertex(from, t.c[i]));
      all.push_back(s);
    }
  all.push_back(random_triangles(3, 500));
  all.push_back(slivers(4, 300));
  return all;
}

}  // namespace grelha::test
