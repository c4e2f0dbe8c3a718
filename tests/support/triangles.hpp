#pragma once
// Triangles by themselves, and as the scalar kernel tests them.

#define GRELHA_ISA scalar
#include "kernel/shapes/triangle.hpp"

#include "tests/support/random.hpp"
#include "tests/support/rays.hpp"

namespace grelha::test {

struct Shape {
  Float3 a, b, c;
};

/// Any size and place; some slivers, some along the axes, some with whole coordinates.
inline Shape random_shape(Random& random, double& size) {
  size = random.log_in(1e-12, 1e12);
  Shape s;
  s.a = random.chance(.3) ? Float3{} : random.point(size * random.log_in(1e-2, 1e3));
  s.b = at(s.a, size, random.direction());
  s.c = random.chance(.2) ? at(s.b, size * 1e-3, random.direction())
                          : at(s.a, size * random.in(.2, 1), random.direction());
  if (random.chance(.2)) {
    const std::uint32_t axis = random.below(3);
    component(s.b, axis) = component(s.c, axis) = component(s.a, axis);
  }
  return s;
}

inline scalar::Vec3<float> permute_axes(const Float3& p, int k) {
  const float q[3] = {p.x, p.y, p.z};
  return {q[k == 2 ? 0 : k + 1], q[k == 0 ? 2 : k - 1], q[k]};
}

inline scalar::TriangleVertices<float> vertices_of(const Shape& s, int k) {
  return {permute_axes(s.a, k), permute_axes(s.b, k), permute_axes(s.c, k)};
}

}  // namespace grelha::test
