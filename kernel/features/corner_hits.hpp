#pragma once
// What the corner rays of a beam meet.

#include "kernel/features/beam_frame.hpp"
#include "kernel/trace/trace.hpp"

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

/// Nearest hits of the corner rays.
inline void trace_corners(const SceneView& scene, const Beam& beam, Sight& sight, Counters& n) {
  Packet<InFloat> p;
  p.size = kCorners;
  for (int i = 0; i < kCorners; ++i)
    set_ray(p, i, beam.org[i], beam.dir[i], kInfinity);
  trace_packet<false>(scene, p, {16, true}, n);
  for (int i = 0; i < kCorners; ++i) {
    sight.id[i] = id_of(p.id[i]);
    sight.t[i] = t_of(p, i);
  }
}

/// The w before which all corner rays end, with room for rounding.
[[gnu::always_inline]] inline float farthest_hit(const BeamFrame& f,
                                                 const Beam& beam,
                                                 const Sight& sight) {
  float far = 0;
  for (int i = 0; i < kCorners; ++i) {
    float w = kInfinity;
    if (sight.id[i] != kNoPrimitive)
      w = place(f, beam.org[i] + sight.t[i] * beam.dir[i]).w * kBehindHit;
    far = greater(w, far);
  }
  return far;
}

}  // namespace grelha::GRELHA_ISA
