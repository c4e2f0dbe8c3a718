#pragma once
// Rays as callers of a Variant hold them, by whichever method is asked for.

#include "kernel/trace/trace.hpp"
#include "kernel/query/variants.hpp"

namespace grelha::GRELHA_ISA {

inline void add(const Counters& n, TraceCounts& to) {
  to.visits += n.visits;
  to.tests.sphere += n.tests[kNumber<Sphere>];
  to.tests.triangle += n.tests[kNumber<Triangle>];
  to.tests.cone += n.tests[kNumber<Cone>];
  to.tests.plane += n.tests[kNumber<Plane>];
  to.packets.formed += n.formed;
  to.packets.fell_back += n.fell_back;
  to.packets.lanes_issued += n.issued;
  to.packets.lanes_busy += n.busy;
}

/// Copies `count` floats of an array of the caller's, from ray `first` on; of null, `instead`.
inline void load(const float* from,
                 std::ptrdiff_t stride,
                 std::size_t first,
                 int count,
                 float instead,
                 float* to) {
  if (!from)
    for (int i = 0; i < count; ++i)
      to[i] = instead;
  else if (stride == 1)
    __builtin_memcpy(to, from + first, static_cast<std::size_t>(count) * sizeof(float));
  else
    for (int i = 0; i < count; ++i)
      to[i] = from[(static_cast<std::ptrdiff_t>(first) + i) * stride];
}

/// Rays on their way, in arrays of our own.
struct Chunk {
  static constexpr int kSize = 256;
  alignas(64) float org[3][kSize], dir[3][kSize], t_min[kSize], t[kSize], shift[kSize];
  alignas(64) double t_double[kSize];
  std::uint32_t id[kSize];
  std::size_t first;
  int count;

  void load_from(const Rays& rays) {
    for (int a = 0; a < 3; ++a) {
      load(rays.org[a], rays.org_stride, first, count, 0, org[a]);
      load(rays.dir[a], rays.dir_stride, first, count, 0, dir[a]);
    }
    load(rays.t_min, rays.t_stride, first, count, 0, t_min);
    load(rays.t_max, rays.t_stride, first, count, kInfinity, t);
    load(nullptr, 1, 0, count, 0, shift);
  }
};

inline bool wants_double(const Hits& hits) { return hits.t_double != nullptr; }
inline bool wants_double(const std::uint8_t*) { return false; }

template <class In>
inline void store(const Chunk& c, const Rays& rays, const Hits& hits) {
  const auto at = [&](int i) { return static_cast<std::ptrdiff_t>(c.first) + i; };
  alignas(64) float t[Chunk::kSize];
  load(rays.t_max, rays.t_stride, c.first, c.count, kInfinity, t);
  if (hits.t_double)
    for (int i = 0; i < c.count; ++i)
      hits.t_double[at(i)] = c.id[i] != kNoPrimitive ? c.t_double[i] : t[i];
  for (int i = 0; i < c.count; ++i) {
    const float met = In::kDouble ? static_cast<float>(c.t_double[i]) : c.t[i] + c.shift[i];
    t[i] = c.id[i] != kNoPrimitive ? met : t[i];
  }
  if (hits.stride == 1) {
    const std::size_t bytes = static_cast<std::size_t>(c.count) * sizeof(float);
    if (hits.t)
      __builtin_memcpy(hits.t + at(0), t, bytes);
    if (hits.id)
      __builtin_memcpy(hits.id + at(0), c.id, bytes);
    return;
  }
  for (int i = 0; i < c.count && hits.t; ++i)
    hits.t[at(i) * hits.stride] = t[i];
  for (int i = 0; i < c.count && hits.id; ++i)
    hits.id[at(i) * hits.stride] = c.id[i];
}
template <class In>
inline void store(const Chunk& c, const Rays&, std::uint8_t* blocked) {
  for (int i = 0; i < c.count; ++i)
    blocked[c.first + static_cast<std::size_t>(i)] = c.id[i] != kNoPrimitive;
}

template <bool kAny, class In, class Answers>
inline void trace_span(const SceneView& scene,
                       const Rays& rays,
                       const Answers& answers,
                       const TraceSettings& settings,
                       TraceCounts& counts) {
  Chunk c;
  Counters n;
  for (c.first = 0; c.first < rays.count; c.first += Chunk::kSize) {
    const std::size_t left = rays.count - c.first;
    c.count = left < Chunk::kSize ? static_cast<int>(left) : Chunk::kSize;
    c.load_from(rays);
    const RayArrays arrays{
        .ox = c.org[0],
        .oy = c.org[1],
        .oz = c.org[2],
        .dx = c.dir[0],
        .dy = c.dir[1],
        .dz = c.dir[2],
        .t_min = c.t_min,
        .t = c.t,
        .id = c.id,
        .shift = c.shift,
        .whole = In::kDouble || wants_double(answers) ? c.t_double : nullptr,
    };
    trace<kAny, In>(scene,
                    arrays,
                    c.count,
                    {settings.method == Method::kSingle ? 1 : settings.packet, settings.mailbox},
                    n);
    store<In>(c, rays, answers);
  }
  add(n, counts);
}

template <class In>
inline void closest(const SceneView& scene,
                    const Rays& rays,
                    const Hits& hits,
                    const TraceSettings& s,
                    TraceCounts& counts) {
  trace_span<false, In>(scene, rays, hits, s, counts);
}
template <class In>
inline void occluded(const SceneView& scene,
                     const Rays& rays,
                     std::uint8_t* blocked,
                     const TraceSettings& s,
                     TraceCounts& counts) {
  trace_span<true, In>(scene, rays, blocked, s, counts);
}

}  // namespace grelha::GRELHA_ISA
