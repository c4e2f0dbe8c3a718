#pragma once
// What each variant_*.cpp compiles: the hot loops behind the functions of a Variant. Included once per instruction set.

#include "kernel/band.hpp"
#include "kernel/points.hpp"
#include "kernel/reference.hpp"
#include "kernel/variants.hpp"

namespace grelha::GRELHA_ISA {

inline void add(const Counters& n, TraceCounts& to) {
  to.visits += n.visits;
  to.tests.sphere += n.sphere, to.tests.triangle += n.triangle, to.tests.cone += n.cone, to.tests.plane += n.plane;
  to.packets.formed += n.formed, to.packets.fell_back += n.fell_back;
  to.packets.lanes_issued += n.issued, to.packets.lanes_busy += n.busy;
}

/// Rays are traced in arrays of our own, far ones brought near; t is written back where something was met.
template <bool kAny>
inline void trace_span(const SceneView& scene, const RaySpan& rays, const TraceSettings& settings, TraceCounts& counts) {
  constexpr int kChunk = 256;
  alignas(64) float moved[7][kChunk], t[kChunk], shifts[kChunk];
  Counters n;
  for (int first = 0; first < rays.count; first += kChunk) {
    const int count = rays.count - first < kChunk ? rays.count - first : kChunk;
    for (int i = 0; i < count; ++i) {
      const int r = first + i;
      float org[3] = {rays.ox[r], rays.oy[r], rays.oz[r]};
      const float dir[3] = {rays.dx[r], rays.dy[r], rays.dz[r]};
      const double shift = approach(scene, org, dir);
      for (int a = 0; a < 3; ++a) moved[a][i] = org[a], moved[3 + a][i] = dir[a];
      moved[6][i] = static_cast<float>(rays.t_min[r] - shift), t[i] = static_cast<float>(rays.t[r] - shift);
      shifts[i] = static_cast<float>(shift);
    }
    const RayArrays arrays{moved[0], moved[1], moved[2], moved[3], moved[4], moved[5], moved[6], t, rays.id + first};
    if (settings.method == Method::kReference)
      trace_reference<kAny>(scene, arrays, count, settings.mailbox, n);
    else
      trace<kAny>(scene, arrays, count, {settings.method == Method::kSingle ? 1 : settings.packet, settings.mailbox}, n);
    for (int i = 0; i < count; ++i)
      if (rays.id[first + i] != kNoPrimitive) rays.t[first + i] = t[i] + shifts[i];
  }
  add(n, counts);
}

inline void closest(const SceneView& scene, const RaySpan& rays, const TraceSettings& s, TraceCounts& counts) {
  trace_span<false>(scene, rays, s, counts);
}
inline void occluded(const SceneView& scene, const RaySpan& rays, const TraceSettings& s, TraceCounts& counts) {
  trace_span<true>(scene, rays, s, counts);
}

inline void band(const SceneView& scene, const ShadingView& shading, const FrameView& frame, int y0, int y1, const BandWork& work,
                 TraceCounts& trace_counts, RayCounts& ray_counts) {
  Counters n;
  RayTally rays;
  render_band(scene, shading, frame, y0, y1, work, n, rays);
  add(n, trace_counts);
  ray_counts.primary += rays.primary, ray_counts.shadow += rays.shadow;
  ray_counts.reflection += rays.reflection, ray_counts.refraction += rays.refraction;
}

inline void points(const SceneView& scene, const ShadingView& shading, const FrameView& frame, const PointList& list, const BandWork& work,
                   TraceCounts& trace_counts, RayCounts& ray_counts) {
  Counters n;
  RayTally rays;
  render_points(scene, shading, frame, list, work, n, rays);
  add(n, trace_counts);
  ray_counts.primary += rays.primary, ray_counts.shadow += rays.shadow;
  ray_counts.reflection += rays.reflection, ray_counts.refraction += rays.refraction;
}

inline void powers(const float* x, const float* y, float* out, int count) {
  for (int i = 0; i < count; i += kWidth<Lanes>) {
    alignas(64) float in[2][kWidth<Lanes>], r[kWidth<Lanes>];
    const int left = count - i < kWidth<Lanes> ? count - i : kWidth<Lanes>;
    for (int k = 0; k < kWidth<Lanes>; ++k) in[0][k] = x[i + (k < left ? k : 0)], in[1][k] = y[i + (k < left ? k : 0)];
    store(r, power(load<Lanes>(in[0]), load<Lanes>(in[1])));
    for (int k = 0; k < left; ++k) out[i + k] = r[k];
  }
}

}  // namespace grelha::GRELHA_ISA

#define GRELHA_LOOPS {GRELHA_ISA::closest, GRELHA_ISA::occluded, GRELHA_ISA::band, GRELHA_ISA::powers, GRELHA_ISA::points}
