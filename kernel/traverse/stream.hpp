#pragma once
// Traces any number of rays through a whole scene, a packet at a time. Rays are loaded from the
// caller's arrays, and their hits are stored.

#include "kernel/traverse/trace.hpp"

namespace grelha::GRELHA_ISA {

/// A row of a packet to or from a caller's array: too short for a call of the library's copy.
inline void copy_row(const float* from, int count, float* to) {
  constexpr int w = kWidth<VFloat>;
  int i = 0;
  for (; i + w <= count; i += w)
    store(to + i, take<VFloat>(from + i));
  for (; i < count; ++i)
    to[i] = from[i];
}

/// Elements [first, first + count) of an array of a view; of null, `instead`.
[[gnu::noinline]] inline void load_floats(const float* from,
                                          std::ptrdiff_t stride,
                                          std::size_t first,
                                          int count,
                                          float instead,
                                          float* to) {
  if (from && stride == 1) {
    if (count <= 16)  // short streams mostly follow each other; prefetching beyond an array is safe
      __builtin_prefetch(from + first + 4 * 16);
    copy_row(from + first, count, to);
    return;
  }
  if (!from || stride == 0) {
    const float all = from ? *from : instead;
    for (int i = 0; i < count; ++i)
      to[i] = all;
    return;
  }
  from += static_cast<std::ptrdiff_t>(first) * stride;
  for (int i = 0; i < count; ++i)
    to[i] = from[i * stride];
}
inline void load_t_max(const Rays& rays, std::size_t first, int count, float* to) {
  load_floats(rays.t_max, rays.t_stride, first, count, kInfinity, to);
}

/// Notes the rows of rays from `next` on.
inline void prefetch_rays(const Rays& rays, std::size_t next, Prefetcher& ahead) {
  ahead.clear();
  if (next >= rays.count)
    return;
  const auto add = [&](const float* array, std::ptrdiff_t stride) {
    if (array && stride == 1)
      ahead.add(array + next);
  };
  for (int a = 0; a < 3; ++a) {
    add(rays.org[a], rays.org_stride);
    add(rays.dir[a], rays.dir_stride);
  }
  add(rays.t_min, rays.t_stride);
  add(rays.t_max, rays.t_stride);
}

/// Rays from `first` on, as many as the packet's size says.
inline void load_rays(const Rays& rays, std::size_t first, Packet& p) {
  for (int a = 0; a < 3; ++a) {
    load_floats(rays.org[a], rays.org_stride, first, p.size, 0, p.org[a]);
    load_floats(rays.dir[a], rays.dir_stride, first, p.size, 0, p.dir[a]);
  }
  load_floats(rays.t_min, rays.t_stride, first, p.size, 0, p.t_min);
  load_t_max(rays, first, p.size, p.best);
  prefetch_rays(rays, first + static_cast<std::size_t>(p.size), p.ahead);
}

/// The same of rays of our own: strides of org and dir are 1, all start at t = 0 and end at t_max.
inline void load_own_rays(const Rays& rays, float t_max, std::size_t first, Packet& p) {
  for (int a = 0; a < 3; ++a) {
    copy_row(rays.org[a] + first, p.size, p.org[a]);
    copy_row(rays.dir[a] + first, p.size, p.dir[a]);
  }
  for (int i = 0; i < p.size; i += kWidth<VFloat>) {
    store(p.t_min + i, VFloat(0));
    store(p.best + i, VFloat(t_max));
  }
}

/// What the rays of a view leave out, packet by packet.
class StreamFilter {
 public:
  StreamFilter(const SceneView& scene, const Rays& rays, const TraceOptions& options)
      : all_{rays.skip, rays.mask, options.masks, scene.copies},
        filters_(rays.skip || rays.mask || options.masks) {}
  /// Gives a packet that begins with ray `first` its filter, which holds until the next one.
  void set(std::size_t first, Packet& p) {
    here_ = all_.after(first);
    p.filter = filters_ ? &here_ : nullptr;
  }

 private:
  RayFilter all_, here_;
  bool filters_;
};

/// Number of rays that are loaded together, so that many step side by side when packets fall apart.
/// Without a grid to walk, no more than stay in the first cache.
inline int rays_of_a_packet(const SceneView& scene) {
  constexpr int few = 64;
  return scene.grid_count == 0 ? few : kPacket;
}

/// Closest hits (kAny false) or occlusion (kAny true) of `count` rays, `options.packet` neighbours
/// at a time. `load(p, first)` fills a packet of p.size rays from `first` on, and `store(p, first)`
/// takes its answers.
template <bool kAny, class Load, class Store>
inline void trace(const SceneView& scene,
                  std::size_t count,
                  const TraceOptions& options,
                  TraceCounts& n,
                  const Load& load,
                  const Store& store) {
  Packet p;
  const int most = rays_of_a_packet(scene);
  const auto step = static_cast<std::size_t>(most);
  for (std::size_t first = 0; first < count; first += step) {
    p.size = count - first < step ? static_cast<int>(count - first) : most;
    load(p, first);
    trace_packet<kAny>(scene, p, options, n);
    store(p, first);
  }
}

/// Words of four bytes to every stride-th element from `first` on.
template <class T>
inline void store_words(
    const float* from, int count, std::size_t first, std::ptrdiff_t stride, T* to) {
  static_assert(sizeof(T) == sizeof(float));
  to += static_cast<std::ptrdiff_t>(first) * stride;
  if (stride == 1)
    __builtin_memcpy(to, from, static_cast<std::size_t>(count) * sizeof(float));
  else
    for (int i = 0; i < count; ++i)
      __builtin_memcpy(to + i * stride, from + i, sizeof(float));
}

inline bool met(const Packet& p, int i) {
  return id_of(p.id[i]) != kNoPrimitive;
}

/// Stores t of a packet's hits, if some surfaces are computed from t.
inline void store_t_of_positions(const Packet& p, float* to) {
  using PositionedByT = decltype(shapes_positioned_by_t(Shapes{}));
  bool some = false;
  PositionedByT::for_each(
      [&]<class Shape>() { some = some || p.geometry->ids.count(Shape::kKind) > 0; });
  for (int i = 0; some && i < p.size; i += kSimdWidth)
    round_hits<PositionedByT>(p, i, to + i);
}

inline void store_doubles(const Packet& p, const Rays& rays, std::size_t first, double* to) {
  float t_max[kPacket];
  load_t_max(rays, first, p.size, t_max);
  for (int i = 0; i < p.size; ++i)
    to[i] = met(p, i) ? double_t(*p.geometry, caller_ray(p, i), id_of(p.id[i])) : t_max[i];
}

/// Barycentric coordinates; 0 of rays that hit no triangle.
inline void store_barycentric(const Packet& p, std::size_t first, const Hits& hits) {
  for (int i = 0; i < p.size; ++i) {
    const std::uint32_t id = id_of(p.id[i]);
    Barycentric at;
    if (p.geometry->ids.has(PrimitiveKind::kTriangle, id))
      at = barycentric(*p.geometry, p.given.ray(i), id);
    if (hits.u)
      hits.u[first + static_cast<std::size_t>(i)] = at.u;
    if (hits.v)
      hits.v[first + static_cast<std::size_t>(i)] = at.v;
  }
}

inline void store_hits(const Packet& p, const Rays& rays, std::size_t first, const Hits& hits) {
  if (hits.id)
    store_words(p.id, p.size, first, hits.stride, hits.id);
  if (hits.t_double)
    store_doubles(p, rays, first, hits.t_double + first);
  if (hits.u || hits.v)
    store_barycentric(p, first, hits);
  if (!hits.t)
    return;
  alignas(64) float t_max[kPacket];
  alignas(64) float t_min[kPacket];
  alignas(64) float t[kPacket];
  const int last = (p.groups - 1) * kSimdWidth;
  store(t_max + last, VFloat(0));
  store(t_min + last, VFloat(0));
  load_t_max(rays, first, p.size, t_max);
  load_floats(rays.t_min, rays.t_stride, first, p.size, 0, t_min);
  for (int i = 0; i < p.groups * kSimdWidth; i += kSimdWidth)
    store(t + i, load<VFloat>(t_max + i));
  for (int i = 0; i < p.size; i += kSimdWidth) {
    round_hits<Shapes>(p, i, t + i);
    const VFloat to = load<VFloat>(t + i);
    const unsigned within =
        bits(mask_and(to > load<VFloat>(t_min + i), to < load<VFloat>(t_max + i)));
    const unsigned hits_here = bits_where(ids_at(p, i) != kNoPrimitive);
    each_bit(hits_here & ~within,
             [&](int k) { t[i + k] = strictly_between(t[i + k], t_min[i + k], t_max[i + k]); });
  }
  store_words(t, p.size, first, hits.stride, hits.t);
}

/// Finds the closest hits of the rays of a view.
inline void closest(const SceneView& scene,
                    const Rays& rays,
                    const Hits& hits,
                    const TraceOptions& options,
                    TraceCounts& n) {
  StreamFilter filter(scene, rays, options);
  const auto load = [&](Packet& p, std::size_t first) {
    load_rays(rays, first, p);
    filter.set(first, p);
    if (hits.stride == 1 && hits.t && hits.id) {
      p.ahead.add(hits.t + first);
      p.ahead.add(hits.id + first);
    }
  };
  const auto store = [&](const Packet& p, std::size_t first) { store_hits(p, rays, first, hits); };
  trace<false>(scene, rays.count, options, n, load, store);
}

}  // namespace grelha::GRELHA_ISA
