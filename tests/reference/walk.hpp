#pragma once
// The report's way, kept as the reference all others are measured against: one ray, one primitive
// at a time, cell by cell. Amanatides & Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing",
// 1987, with two mends: plane distances come from the plane's index instead of adding up, and
// mailboxes stand with the ray instead of the primitive.
//
// It shares with the kernel the double and the exact tests of one ray and one primitive, but
// neither the float tests nor the traversal.

#include "grelha/rays.hpp"
#include "kernel/traverse/trace.hpp"

namespace grelha::GRELHA_ISA {

/// The primitives a ray has hit (hashed; may forget, never wrong).
struct RayMailbox {
  static constexpr unsigned kSize = 64;
  std::uint32_t held[kSize];
  void clear() {
    for (std::uint32_t& id : held)
      id = kNoPrimitive;
  }
  bool seen(std::uint32_t id) {
    std::uint32_t& slot = held[id % kSize];
    if (slot == id)
      return true;
    slot = id;
    return false;
  }
};

/// A ray on its way.
struct WalkedRay {
  float org[3];
  float dir[3];
  float t_min;
  float t_max;
  ExactRay given;
  const GeometryView* geometry;
  float lo, hi;  ///< of t of the nearest so far, or the end of the search
  float unit;    ///< length that t is counted in
  std::uint32_t id = kNoPrimitive;
};

/// Takes primitive `id` if it is hit first. Returns whether the search is over.
template <bool kAny>
bool take(WalkedRay& r, std::uint32_t id) {
  const CrossingSpan span = crossing_span(*r.geometry, r.given, id, 0);
  if (!(span.lo <= r.hi) || id == r.id)
    return false;
  CrossingSpan of_first;
  const bool first =
      span.hi < r.lo ||
      (r.id == kNoPrimitive ? is_before_end(*r.geometry, r.given, id)
                            : is_closest(*r.geometry, r.given, id, r.id, 0, of_first));
  if (!first)
    return false;
  r.id = id;
  r.lo = span.lo;
  r.hi = span.hi;
  return kAny;
}

template <class Shape>
bool is_new(std::uint32_t id, RayMailbox* box, TraceCounts& n) {
  if (box && box->seen(id))
    return false;
  count_tests<Shape>(n, 1);
  return true;
}

template <bool kAny>
bool test_triangles(
    WalkedRay& r, const CellLists& lists, std::size_t cell, RayMailbox* box, TraceCounts& n) {
  const auto [first, end] = lists.of<Triangle>().blocks_of(cell);
  for (std::uint32_t b = first; b < end; ++b) {
    const TriangleBlock& block = lists.of<Triangle>().blocks[b];
    for (int i = 0; i < kBlock && block.id[i] != kNoPrimitive; ++i)
      if (is_new<Triangle>(block.id[i], box, n) && take<kAny>(r, block.id[i]))
        return true;
  }
  return false;
}

template <bool kAny>
bool test_lists(
    WalkedRay& r, const CellLists& lists, std::size_t cell, RayMailbox* box, TraceCounts& n) {
  bool over = lists.of<Triangle>().first && test_triangles<kAny>(r, lists, cell, box, n);
  ArrayShapes::for_each([&]<class Shape>() {
    const typename Shape::CellList& list = lists.of<Shape>();
    const std::uint32_t end = list.first ? list.first[cell + 1] : 0;
    for (std::uint32_t i = list.first ? list.first[cell] : 0; i < end && !over; ++i)
      over = is_new<Shape>(list.id[i], box, n) && take<kAny>(r, list.id[i]);
  });
  return over;
}

template <bool kAny>
bool test_planes(WalkedRay& r, const GeometryView& g, TraceCounts& n) {
  for (std::uint32_t p = 0; p < g.of<Plane>().count; ++p)
    if (is_new<Plane>(p, nullptr, n) && take<kAny>(r, g.ids.begin(PrimitiveKind::kPlane) + p))
      return true;
  return false;
}

template <bool kAny>
bool walk_grid(WalkedRay& r, const GridView& g, RayMailbox* box, TraceCounts& n) {
  const DdaState<double> ray = to_grid(g, r.org, r.dir);
  double t0 = r.t_min;
  double t1 = r.hi;
  clip_to_grid(g, ray, t0, t1);
  if (!(t0 <= t1))
    return false;
  int at[3];
  int step[3];
  double next[3];
  const auto plane = [&](int a) {
    return (at[a] + (step[a] > 0 ? 1 : 0) - ray.origin_in_cells[a]) * ray.inverse[a];
  };
  for (int a = 0; a < 3; ++a) {
    at[a] = clamp_cell(ray.origin_in_cells[a] + t0 * ray.speed[a], g.n[a]);
    step[a] = ray.speed[a] > 0 ? 1 : -1;
    next[a] = plane(a);
  }
  const int most = g.n[0] + g.n[1] + g.n[2] + 3;
  for (int s = 0; s < most; ++s) {
    ++n.visits;
    const std::size_t cell = at[0] + static_cast<std::size_t>(g.n[0]) *
                                         (at[1] + static_cast<std::size_t>(g.n[1]) * at[2]);
    if (test_lists<kAny>(r, g.lists, cell, box, n))
      return true;
    const int a = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    if (r.hi <= next[a] || !(next[a] <= t1))
      return false;
    at[a] += step[a];
    if (at[a] < 0 || at[a] >= g.n[a])
      return false;
    next[a] = plane(a);
  }
  return false;
}

/// All cells of a grid, one after the other.
template <bool kAny>
bool test_cells(WalkedRay& r, const GridView& g, RayMailbox* box, TraceCounts& n) {
  const std::size_t cells = static_cast<std::size_t>(g.n[0]) * static_cast<std::size_t>(g.n[1]) *
                            static_cast<std::size_t>(g.n[2]);
  for (std::size_t cell = 0; cell < cells; ++cell)
    if (test_lists<kAny>(r, g.lists, cell, box, n))
      return true;
  return false;
}

/// False when the ray can hit nothing. Lengths of directions are those of the kernel.
inline bool load_ray(Ray ray, const GeometryView& g, WalkedRay& r) {
  const float unit = r.unit = direction_scale(Vec3<float>{ray.dir.x, ray.dir.y, ray.dir.z});
  const bool is_empty = !(next_above(ray.t_min) < ray.t_max);
  if (unit != 1)
    ray.t_max = finite_end(unit, ray.t_max);
  const double begin = static_cast<double>(unit) * ray.t_min;
  const double end = static_cast<double>(unit) * ray.t_max;
  if (unit != 1)
    scale_interval(unit, ray.t_min, ray.t_max);
  const float org[3] = {ray.org.x, ray.org.y, ray.org.z};
  const float d[3] = {ray.dir.x / unit, ray.dir.y / unit, ray.dir.z / unit};
  for (int a = 0; a < 3; ++a) {
    r.org[a] = org[a];
    r.dir[a] = d[a];
  }
  r.t_min = ray.t_min;
  r.t_max = r.lo = r.hi = ray.t_max;
  r.given = {{org[0], org[1], org[2]}, {d[0], d[1], d[2]}, begin, end};
  r.geometry = &g;
  const float dd = (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2];
  return ((((org[0] + org[1]) + (org[2] + dd)) + 1 / dd) * 0 == 0) && !is_empty;
}

template <bool kAny>
void trace_ray(const SceneView& scene, WalkedRay& r, RayMailbox* box, TraceCounts& n) {
  if (test_planes<kAny>(r, scene.geometry, n) || test_lists<kAny>(r, scene.outside, 0, nullptr, n))
    return;
  for (int i = 0; i < scene.grid_count; ++i) {
    const GridView& g = scene.grids[i];
    if (starts_near(g, vec(r.org)) ? walk_grid<kAny>(r, g, box, n) : test_cells<kAny>(r, g, box, n))
      return;
  }
}

/// Ray i of a view.
inline Ray ray_of(const Rays& rays, std::size_t i) {
  const auto k = static_cast<std::ptrdiff_t>(i);
  const auto vector = [&](const float* const(&of)[3], std::ptrdiff_t stride) {
    return Float3{of[0][k * stride], of[1][k * stride], of[2][k * stride]};
  };
  return {vector(rays.org, rays.org_stride),
          vector(rays.dir, rays.dir_stride),
          rays.t_min ? rays.t_min[k * rays.t_stride] : 0,
          rays.t_max ? rays.t_max[k * rays.t_stride] : kInfinity};
}

/// Calls `take(i, ray, r)` for each ray of a view: as it came, and as it was walked.
template <bool kAny, class Take>
void trace_reference(
    const SceneView& scene, const Rays& rays, bool mailbox, TraceCounts& n, const Take& take) {
  RayMailbox box;
  for (std::size_t i = 0; i < rays.count; ++i) {
    const Ray ray = ray_of(rays, i);
    WalkedRay r;
    if (load_ray(ray, scene.geometry, r)) {
      box.clear();
      trace_ray<kAny>(scene, r, mailbox ? &box : nullptr, n);
    }
    take(static_cast<std::ptrdiff_t>(i), ray, r);
  }
}

/// The query loops of a Variant, see VariantLoops.
inline void closest(
    const SceneView& scene, const Rays& rays, bool mailbox, TraceCounts& n, const Hits& hits) {
  const auto store = [&](std::ptrdiff_t i, const Ray& ray, const WalkedRay& r) {
    const bool met = r.id != kNoPrimitive;
    if (hits.t)
      hits.t[i * hits.stride] =
          met ? strictly_between(rounded_t(scene.geometry, r.given.in_units_of(1 / r.unit), r.id),
                                 ray.t_min,
                                 ray.t_max)
              : ray.t_max;
    if (hits.id)
      hits.id[i * hits.stride] = r.id;
    if (hits.t_double)
      hits.t_double[i] =
          met ? double_t(scene.geometry, r.given.in_units_of(1 / r.unit), r.id) : ray.t_max;
  };
  trace_reference<false>(scene, rays, mailbox, n, store);
}
inline void occluded(
    const SceneView& scene, const Rays& rays, bool mailbox, TraceCounts& n, std::uint8_t* blocked) {
  trace_reference<true>(
      scene, rays, mailbox, n, [&](std::ptrdiff_t i, const Ray&, const WalkedRay& r) {
        blocked[i] = r.id != kNoPrimitive;
      });
}

}  // namespace grelha::GRELHA_ISA
