#pragma once
// How often a mesh winds around a point, in rational numbers (GMP).

#include <array>
#include <optional>

#include "tests/support/random.hpp"
#include "tests/support/rational.hpp"

namespace grelha::test::rational {

/// How a ray from a point crosses a triangle: 1 outwards, -1 inwards, 0 not at all. None where it
/// meets an edge, a corner or the plane, or where the point lies in the triangle.
inline std::optional<int> crossing_side(const Float3& point,
                                        const Float3& dir,
                                        const std::array<Float3, 3>& corner) {
  if (passes_by({point, dir}, corner[0], corner[1], corner[2]))
    return 0;
  const Vector org(point), d(dir);
  const Vector p[3] = {Vector(corner[0]) - org, Vector(corner[1]) - org, Vector(corner[2]) - org};
  int side = 0;
  bool mixed = false;
  for (int k = 0; k < 3; ++k) {
    const int sign = sgn(dot(cross(p[k], p[(k + 1) % 3]), d));
    if (sign == 0)
      return {};
    mixed |= side != 0 && sign != side;
    side = sign;
  }
  if (mixed)
    return 0;
  // the volume over the point has the side's sign if the triangle is ahead
  const int ahead = sgn(dot(cross(p[0], p[1]), p[2]));
  if (ahead == 0)
    return {};
  return ahead == side ? side : 0;
}

/// Crossings outwards less those inwards, of a ray that meets no edge; of a closed and oriented
/// mesh this is how often it winds around the point. None if the point lies on the mesh.
inline std::optional<int> winding(const Triangles& t, const Float3& point, Random& random) {
  for (int attempt = 0; attempt < 8; ++attempt) {
    const Float3 dir = random.direction();
    int sum = 0;
    bool clear = true;
    for (std::size_t i = 0; clear && i < t.size(); ++i) {
      const auto at = [&](std::uint32_t v) { return Float3{t.x[v], t.y[v], t.z[v]}; };
      const auto side = crossing_side(point, dir, {at(t.a[i]), at(t.b[i]), at(t.c[i])});
      clear = side.has_value();
      sum += side.value_or(0);
    }
    if (clear)
      return sum;
  }
  return {};
}

}  // namespace grelha::test::rational
