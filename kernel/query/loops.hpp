#pragma once
// The loops of a Variant that take a caller's rays.

#include "kernel/query/variants.hpp"
#include "kernel/traverse/one_ray.hpp"
#include "kernel/traverse/stream.hpp"

namespace grelha::GRELHA_ISA {

/// Stores a byte for each ray of a packet: whether it hit anything.
inline void store_blocked(const Packet& p, std::uint8_t* to) {
  std::uint8_t bytes[kPacket];  // which nothing else may point to: SIMD
  for (int i = 0; i < p.size; ++i)
    bytes[i] = met(p, i);
  __builtin_memcpy(to, bytes, static_cast<std::size_t>(p.size));
}

inline void occluded(const SceneView& scene,
                     const Rays& rays,
                     std::uint8_t* blocked,
                     const TraceOptions& options,
                     TraceCounts& counts) {
  const auto store = [&](const Packet& p, std::size_t first) { store_blocked(p, blocked + first); };
  StreamFilter filter(scene, rays, options);
  const auto load = [&](Packet& p, std::size_t first) {
    load_rays(rays, first, p);
    filter.set(first, p);
  };
  trace<true>(scene, rays.count, options, counts, load, store);
}

/// A ray by itself, and what it leaves out, or null.
template <bool kAny>
inline Hit trace_one(const SceneView& scene, const Ray& ray, const Filter* filter) {
  RayFilter of_ray;
  if (filter)
    of_ray = {&filter->skip, &filter->mask, filter->masks.data(), scene.copies};
  // called once: of two calls the compiler inlines neither
  return trace_one<kAny>(scene, ray, filter ? &of_ray : nullptr);
}
inline Hit closest_one(const SceneView& scene, const Ray& ray, const Filter* filter) {
  return trace_one<false>(scene, ray, filter);
}
inline bool occluded_one(const SceneView& scene, const Ray& ray, const Filter* filter) {
  return trace_one<true>(scene, ray, filter).id != kNoPrimitive;
}

}  // namespace grelha::GRELHA_ISA
