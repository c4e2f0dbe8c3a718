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
