#pragma once
// The loops of a Variant that take a caller's rays: for hits, and for lists of all that they may
// cross.

#include "kernel/query/variants.hpp"
#include "kernel/traverse/one_ray.hpp"
#include "kernel/traverse/stream.hpp"
#include "kernel/query/streams.hpp"

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

/// Lists the planes that a ray may cross.
template <class Ray>
inline void list_infinite(const SceneView& scene, Ray r) {
  const GeometryView& g = scene.geometry;
  if (r.rays.candidates->wanted == Wanted::kAll)
    InfiniteShapes::for_each([&]<class Shape>() {
      for (std::uint32_t k = 0; k < g.of<Shape>().count; ++k)
        list_candidate(r, g.ids.begin(Shape::kKind) + k);
    });
}
/// Lists the primitives in arrays of a cell.
template <class Ray>
inline void list_arrays(Ray r, const CellLists& lists, std::size_t cell) {
  ArrayShapes::for_each([&]<class Shape>() {
    if (lists.of<Shape>().first)
      list_rows<Shape>(r, lists.of<Shape>(), cell);
  });
}

/// For walk_scene().
struct ListTests {
  static constexpr bool kInAnyOrder = true;
  static bool block(Single& r, const TriangleBlock& block) {
    list_triangles(SingleRay{r}, block);
    return false;
  }
  static bool arrays(Single& r, const CellLists& lists, std::size_t cell) {
    list_arrays(SingleRay{r}, lists, cell);
    return false;
  }
};

/// Lists the candidates of one ray by itself.
inline void list_one(const SceneView& scene, const Ray& ray, CandidateSink& to) {
  Single r;
  r.candidates = &to;
  if (!prepare(r, ray, scene.geometry.of<Triangle>().count > 0))
    return;
  r.geometry = &scene.geometry;
  ListTests tests;
  list_infinite(scene, SingleRay{r});
  walk_scene(scene, r, tests);
}

/// Lists what stands in no grid for the rays of a packet.
inline void list_outside(const SceneView& scene, Packet& p) {
  if (scene.outside.of<Sphere>().first)
    p.error_bound = error_bound_of(scene, p);
  const Triangle::CellList& triangles = scene.outside.of<Triangle>();
  for (int i = 0; i < p.size; ++i) {
    const PacketRay r{p, i};
    if (!(p.best[i] > p.t_min[i]))
      continue;
    list_infinite(scene, r);
    for (std::uint32_t b = 0; triangles.first && b < triangles.first[1]; ++b)
      list_triangles(r, triangles.blocks[b]);
    list_arrays(r, scene.outside, 0);
  }
}

/// Lists the candidates of the rays of a packet, each of which goes on its own.
inline void list_packet(const SceneView& scene, Packet& p) {
  TraceCounts unread;
  prepare(p, scene.geometry, scene.geometry.of<Triangle>().count > 0);
  list_outside(scene, p);
  for (int i = 0; i < scene.grid_count; ++i) {
    const GridView& g = scene.grids[i];
    const Starts starts = set_starts(g, p);
    p.error_bound = g.error_bound;
    if (starts.any_near)
      stream_traverse<Find::kAll>(g, p, unread);
    if (!starts.any_far)
      continue;
    FarRays far(g, p);
    if (far.any())
      stream_traverse<Find::kAll>(in_grid_frame(g), far.packet(), unread);
  }
}

/// Rays that are sooner listed one by one than as a packet.
inline constexpr std::size_t kFewToList = 4;

/// Lists what each ray may cross between its ends.
inline void collect(const SceneView& scene, const Rays& rays, CandidateSink& to) {
  if (rays.count <= kFewToList) {
    for (std::size_t i = 0; i < rays.count; ++i) {
      list_one(scene, rays[i], to);
      to.end_packet(i, 1);
    }
    return;
  }
  Packet p;
  p.candidates = &to;
  const auto step = static_cast<std::size_t>(rays_of_a_packet(scene));
  for (std::size_t first = 0; first < rays.count; first += step) {
    p.size = static_cast<int>(rays.count - first < step ? rays.count - first : step);
    load_rays(rays, first, p);
    list_packet(scene, p);
    to.end_packet(first, p.size);
  }
}

}  // namespace grelha::GRELHA_ISA
