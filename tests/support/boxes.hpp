#pragma once
// Closed boxes of triangles, turned any way.

#include "tests/support/scenes.hpp"

namespace grelha::test {

/// Three directions at right angles.
struct Axes {
  Float3 way[3];
};
inline Axes random_axes(Random& random) {
  const auto cross = [](const Float3& a, const Float3& b) {
    return Float3{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  };
  const Float3 a = random.direction();
  Float3 b = cross(a, random.direction());
  const double length = std::sqrt(double{b.x} * b.x + double{b.y} * b.y + double{b.z} * b.z);
  b = at({0, 0, 0}, 1 / length, b);
  return {{a, b, cross(a, b)}};
}

/// Adds a box around a place, so long each way; triangles 4 k to 4 k + 3 are the faces that look
/// along way k. All turn outwards.
inline void add_box(Scene& s, const Float3& middle, const Axes& axes, const double (&length)[3]) {
  Float3 corner[8];
  for (int c = 0; c < 8; ++c) {
    corner[c] = middle;
    for (int k = 0; k < 3; ++k)
      corner[c] = at(corner[c], (c >> k & 1 ? .5 : -.5) * length[k], axes.way[k]);
  }
  for (int k = 0; k < 3; ++k)
    for (int side = 0; side < 2; ++side) {
      const int a = side << k;
      const int b = a | 1 << (k + (side == 1 ? 1 : 2)) % 3;
      const int d = a | 1 << (k + (side == 1 ? 2 : 1)) % 3;
      add_triangle(s, corner[a], corner[b], corner[b | d]);
      add_triangle(s, corner[a], corner[b | d], corner[d]);
    }
}

}  // namespace grelha::test
