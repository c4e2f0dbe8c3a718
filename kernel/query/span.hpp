#pragma once
// Rays as callers of a Variant hold them, by whichever method is asked for.

#include "kernel/trace/trace.hpp"
#include "kernel/query/variants.hpp"

namespace grelha::GRELHA_ISA {

inline void add(const Counters& n, TraceCounts& to) {
  to.visits += n.visits;
  to.tests.sphere += n.sphere;
  to.tests.triangle += n.triangle;
  to.tests.cone += n.cone;
  to.tests.plane += n.plane;
  to.packets.formed += n.formed;
  to.packets.fell_back += n.fell_back;
  to.packets.lanes_issued += n.issued;
  to.packets.lanes_busy += n.busy;
}

/// Rays are traced in arrays of our own; t is written back where something was met.
template <bool kAny, class In>
inline void trace_span(const SceneView& scene,
                       const RaySpan& rays,
                       const TraceSettings& settings,
                       TraceCounts& counts) {
  constexpr int kChunk = 256;
  alignas(64) float org[3][kChunk], t_min[kChunk], t[kChunk], shift[kChunk];
  alignas(64) double whole[kChunk];
  std::uint32_t unasked[kChunk];
  Counters n;
  for (int first = 0; first < rays.count; first += kChunk) {
    const int count = rays.count - first < kChunk ? rays.count - first : kChunk;
    const std::size_t bytes = static_cast<std::size_t>(count) * sizeof(float);
    __builtin_memcpy(org[0], rays.ox + first, bytes);
    __builtin_memcpy(org[1], rays.oy + first, bytes);
    __builtin_memcpy(org[2], rays.oz + first, bytes);
    if (rays.t_min)
      __builtin_memcpy(t_min, rays.t_min + first, bytes);
    else
      __builtin_memset(t_min, 0, bytes);
    __builtin_memcpy(t, rays.t + first, bytes);
    __builtin_memset(shift, 0, bytes);
    std::uint32_t* const id = rays.id ? rays.id + first : unasked;
    const RayArrays arrays{org[0],
                           org[1],
                           org[2],
                           rays.dx + first,
                           rays.dy + first,
                           rays.dz + first,
                           t_min,
                           t,
                           id,
                           shift,
                           In::kDouble || rays.whole ? whole : nullptr};
    trace<kAny, In>(scene,
                    arrays,
                    count,
                    {settings.method == Method::kSingle ? 1 : settings.packet, settings.mailbox},
                    n);
    for (int i = 0; i < count; ++i) {  // without a branch: SIMD
      const float met = kAny ? t[i] : In::kDouble ? static_cast<float>(whole[i]) : t[i] + shift[i];
      rays.t[first + i] = id[i] != kNoPrimitive ? met : rays.t[first + i];
    }
    for (int i = 0; i < count && rays.whole; ++i)
      if (id[i] != kNoPrimitive)
        rays.whole[first + i] = whole[i];
  }
  add(n, counts);
}

template <class In>
inline void closest(const SceneView& scene,
                    const RaySpan& rays,
                    const TraceSettings& s,
                    TraceCounts& counts) {
  trace_span<false, In>(scene, rays, s, counts);
}
template <class In>
inline void occluded(const SceneView& scene,
                     const RaySpan& rays,
                     const TraceSettings& s,
                     TraceCounts& counts) {
  trace_span<true, In>(scene, rays, s, counts);
}

}  // namespace grelha::GRELHA_ISA
