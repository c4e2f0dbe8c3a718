#pragma once
// What the corner rays of a beam meet.

#include "kernel/features/beam_frame.hpp"
#include "kernel/shapes/surface.hpp"

namespace grelha::GRELHA_ISA {

struct Sight {
  std::uint32_t id[kCorners];
  float t[kCorners];
};

template <class Test>
inline bool any_of(const std::uint32_t (&id)[kCorners], const Test& test) {
  return test(id[0]) || test(id[1]) || test(id[2]) || test(id[3]);
}

/// Sets ray i of a packet; it searches t from 0 to `end`.
[[gnu::always_inline]] inline void set_ray(
    WalkingRays& p, int i, const Vec3f& org, const Vec3f& dir, float end) {
  p.org[0][i] = org.x;
  p.org[1][i] = org.y;
  p.org[2][i] = org.z;
  p.dir[0][i] = dir.x;
  p.dir[1][i] = dir.y;
  p.dir[2][i] = dir.z;
  p.t_min[i] = 0;
  p.start[i] = 0;
  p.best[i] = end;
}

/// The surfaces that a beam's corners met.
using CornerSurfaces = Surface<float>[kCorners];

/// The w before which a beam ends on a surface that goes on beside its corners as it lies there,
/// with room for rounding.
[[gnu::always_inline]] inline float farthest_hit(const BeamFrame& f, const CornerSurfaces& s) {
  float far = 0;
  for (int i = 0; i < kCorners; ++i) {
    const auto [x, y] = kCornerSigns[i];
    const Vec3f to = s[i].point - f.apex;
    const float w = dot(to, s[i].normal) / dot(f.axis + x * f.right + y * f.up, s[i].normal);
    far = greater(dot(to, f.unit), far);
    far = w > 0 ? greater(w, far) : kInfinity;
  }
  return far * kBehindHit;
}

}  // namespace grelha::GRELHA_ISA
