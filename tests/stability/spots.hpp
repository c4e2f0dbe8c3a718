#pragma once
// Points where rays leave surfaces. Both tracers get the same start points, those that the renderer
// uses (kernel/shapes/surface.hpp).
#ifndef GRELHA_ISA
#define GRELHA_ISA scalar
#endif
#include "kernel/shapes/surface.hpp"
#include "kernel/world/world_impl.hpp"

#include <cmath>

#include "tests/support/random.hpp"

namespace grelha::stability {

inline Float3 of(const scalar::Vec3<float>& v) {
  return {v.x, v.y, v.z};
}
inline double dot_in_double(const Float3& a, const Float3& b) {
  return double(a.x) * b.x + double(a.y) * b.y + double(a.z) * b.z;
}

/// A place on a surface as the renderer knows it, and where it lets a ray start that leaves it.
struct Spot {
  Float3 point, normal;
  float away;
  Float3 start(const Float3& d) const {
    const scalar::Vec3<float> p{point.x, point.y, point.z};
    return of(scalar::offset_origin(p, {normal.x, normal.y, normal.z}, away, {d.x, d.y, d.z}));
  }
};

/// Returns the point where the ray hits primitive `id` at t; a triangle computes t from the ray
/// again.
inline Spot spot(
    const World& world, std::uint32_t id, const Float3& org, const Float3& dir, float t = 0) {
  const scalar::Vec3<float> o{org.x, org.y, org.z};
  const scalar::Vec3<float> d{dir.x, dir.y, dir.z};
  const auto s = scalar::surface_of<float>(world.impl().view.geometry, id, o, d, t, false);
  return {of(s.point), of(s.normal), s.offset};
}

/// Nearly along the surface: the worst to leave it by.
inline Float3 flattened(test::Random& random, const Float3& d, const Float3& normal) {
  return test::at(d, -dot_in_double(d, normal) * (1 - random.log_in(1e-6, 1e-1)), normal);
}

/// So nearly along that rounding decides which side it points to: either answer is right.
inline bool undecided(const Float3& d, const Float3& normal) {
  return std::abs(dot_in_double(d, normal)) < 8 * 6e-8;
}

}  // namespace grelha::stability
