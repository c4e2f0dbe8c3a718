#pragma once
// Meshes whose hits are hard to tell apart.

#include <cstdint>

#include "tests/support/scenes.hpp"

namespace grelha::test {

/// Triangles of a mesh a second time, their corners in another order.
inline Scene with_copies(Scene s) {
  auto& t = s.geometry.triangles;
  for (std::size_t i = 0, n = t.a.size(); i < n; ++i) {
    t.a.push_back(t.b[i]);
    t.b.push_back(t.c[i]);
    t.c.push_back(t.a[i]);
    t.material.push_back(0);
  }
  return s;
}

/// A closed cube from 0 to 1, each side in n x n squares: denormal numbers lie beside three sides.
inline Scene cube_at_zero(int n) {
  Scene s = empty_scene();
  const auto corner = [n](int axis, float height, int u, int v) {
    float p[3];
    p[axis] = height;
    p[(axis + 1) % 3] = static_cast<float>(u) / static_cast<float>(n);
    p[(axis + 2) % 3] = static_cast<float>(v) / static_cast<float>(n);
    return Float3{p[0], p[1], p[2]};
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const float h : {0.f, 1.f})
      for (int u = 0; u < n; ++u)
        for (int v = 0; v < n; ++v) {
          const Float3 a = corner(axis, h, u, v);
          const Float3 b = corner(axis, h, u + 1, v);
          const Float3 c = corner(axis, h, u + 1, v + 1);
          const Float3 d = corner(axis, h, u, v + 1);
          add_triangle(s, a, h > 0 ? b : c, h > 0 ? c : b);
          add_triangle(s, a, h > 0 ? c : d, h > 0 ? d : c);
        }
  return s;
}

/// Triangles a millionth as wide as long.
inline Scene slivers(std::uint64_t seed, int n) {
  Random random(seed);
  Scene s = empty_scene();
  for (int i = 0; i < n; ++i) {
    const Float3 a = random.point(1);
    const Float3 b = random.point(1);
    add_triangle(s, a, b, at(at(a, random.unit(), minus(b, a)), 1e-6, random.direction()));
  }
  return s;
}

}  // namespace grelha::test
