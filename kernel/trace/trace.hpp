#pragma once
// The rays of a packet against a whole scene: planes and outside primitives first, then each grid
// with what t is left.

#include "kernel/trace/afar.hpp"
#include "kernel/trace/approach.hpp"
#include "kernel/walk/packet_traversal.hpp"

namespace grelha::GRELHA_ISA {

/// What stands in no grid since it has no end.
template <bool kAny, class In>
inline void test_infinite(const SceneView& scene, Packet<In>& p, Counters& n) {
  const GeometryView& g = scene.geometry;
  InfiniteShapes::for_each([&]<class Shape>() __attribute__((always_inline)) {
    const typename Shape::Arrays& all = g.of<Shape>();
    for (std::uint32_t i = 0; i < all.count; ++i)
      test_one<kAny, Shape>(p, all.fields, i, g.ids.begin(Shape::kKind) + i, n);
  });
}

/// The triangles that lie in no grid.
template <bool kAny, class In>
inline void test_outside(const Triangle::CellList& list, Packet<In>& p, Counters& n) {
  for (std::uint32_t b = 0; b < list.first[1]; ++b) {
    const TriangleBlock& block = list.blocks[b];
    for (int i = 0; i < kBlock && block.a[0][i] == block.a[0][i]; ++i)
      test_triangle<kAny>(p, triangle_of(block, i), block.id[i], n);
  }
}

/// The few primitives that lie in no grid, each against all rays.
template <bool kAny, class In>
inline void test_outside(const CellLists& lists, Packet<In>& p, Counters& n) {
  if (lists.of<Triangle>().first)
    test_outside<kAny>(lists.of<Triangle>(), p, n);
  ArrayShapes::for_each([&]<class Shape>() __attribute__((always_inline)) {
    const typename Shape::CellList& list = lists.of<Shape>();
    for (std::uint32_t i = 0; list.first && i < list.first[1]; ++i)
      test_one<kAny, Shape>(p, list.fields, i, list.id[i], n);
  });
}

/// Whether a grid is for a ray as it is; there may be another way for those from afar.
inline bool serves(const GridView& g, const float (&org)[3]) {
  return g.serves == Serves::kAll || starts_near(g, org) == (g.serves != Serves::kFar);
}

/// Sets where each ray is to be searched from in a grid: nowhere when the grid is not for it as it
/// is. False: it is for none.
inline bool start_in(const GridView& g, WalkingRays& p) {
  for (int i = 0; i < p.size; i += kWidth<Lanes>)
    store(p.start + i, load<Lanes>(p.t_min + i));
  if (g.serves == Serves::kAll)
    return true;
  bool some = false;
  each_live_group(p, [&](int i, int) {
    Mask<Lanes> away = Lanes(0) != Lanes(0);
    for (int a = 0; a < 3; ++a) {
      const Lanes o = load<Lanes>(p.org[a] + i);
      away = either(away, either(o<Lanes(g.near_lo[a]), o> Lanes(g.near_hi[a])));
    }
    const bool near = g.serves != Serves::kFar;
    const Lanes start = load<Lanes>(p.start + i), never(kInfinity);
    const Lanes from = select(away, near ? never : start, near ? start : never);
    some |= any(from < never);
    store(p.start + i, from);
  });
  return some;
}

/// Where a ray comes to a grid; infinity: never, or along a plane of it.
inline float entry(const GridView& g, const float (&org)[3], const float (&dir)[3], float t_min) {
  float t0 = t_min;
  float t1 = kInfinity;
  for (int a = 0; a < 3; ++a) {
    const float inv = 1 / dir[a];
    const float x = (g.lo_f[a] - org[a]) * inv;
    const float y = (g.hi_f[a] - org[a]) * inv;
    t0 = greater(lesser(x, y), t0);
    t1 = lesser(greater(x, y), t1);
  }
  return t0 <= t1 ? t0 : kInfinity;
}

/// The grids, for closest hits front to back as a ray meets them: what is met early cuts the others
/// short. Answers do not depend on it, since ties go to the lower id.
template <bool kAny, class Visit>
inline void each_grid(const SceneView& scene,
                      const float (&org)[3],
                      const float (&dir)[3],
                      float t_min,
                      const Visit& visit) {
  const int count = scene.grid_count;
  if (kAny || count < 2) {
    for (int g = 0; g < count; ++g)
      visit(scene.grids[g]);
    return;
  }
  int order[kMostGrids];
  float at[kMostGrids];
  for (int g = 0; g < count; ++g) {
    const float t = entry(scene.grids[g], org, dir, t_min);
    int i = g;
    for (; i > 0 && at[i - 1] > t; --i) {
      at[i] = at[i - 1];
      order[i] = order[i - 1];
    }
    at[i] = t;
    order[i] = g;
  }
  for (int i = 0; i < count; ++i)
    visit(scene.grids[order[i]]);
}
/// The same for a packet, as its first ray meets them.
template <bool kAny, class Visit>
inline void each_grid(const SceneView& scene, const WalkingRays& p, const Visit& visit) {
  const float org[3] = {p.org[0][0], p.org[1][0], p.org[2][0]};
  const float dir[3] = {p.dir[0][0], p.dir[1][0], p.dir[2][0]};
  each_grid<kAny>(scene, org, dir, p.t_min[0], visit);
}

template <bool kAny, class In>
inline void trace_alone(const SceneView& scene, Packet<In>& p, Counters& n) {
  for (int i = 0; i < p.size; ++i) {
    if (!(p.best[i] > p.t_min[i]))
      continue;
    PacketRay<In> r{p, i};
    test_cell<kAny>(r, scene.outside, 0, n);
  }
  each_grid<kAny>(scene, p, [&](const GridView& g) {
    if (start_in(g, p))
      walk_apart<kAny>(g, p, n);
    if (g.serves == Serves::kNearAndAfar)
      walk_from_afar<kAny>(g, p, n);
  });
}

template <bool kAny, class In>
[[gnu::noinline]] void trace_packet(const SceneView& scene,
                                    Packet<In>& p,
                                    const TraceOptions& options,
                                    Counters& n) {
  const bool any_triangles = scene.geometry.of<Triangle>().count > 0;
  prepare(p, any_triangles);
  test_infinite<kAny>(scene, p, n);
  bring_near(scene, p);
  if (options.packet == 1)
    return trace_alone<kAny>(scene, p, n);
  test_outside<kAny>(scene.outside, p, n);
  each_grid<kAny>(scene, p, [&](const GridView& g) {
    if (start_in(g, p))
      traverse_packet<kAny>(g, p, options.packet, options.mailbox, n);
    if (g.serves == Serves::kNearAndAfar)
      walk_from_afar<kAny>(g, p, n);
  });
}

/// t of a hit between the ends of its search, which rounding may have taken it to.
inline float strictly_between(float t, float t_min, float t_max) {
  const float after = t > t_min ? t : next_above(t_min);
  return after < t_max ? after : next_below(t_max);
}
inline double strictly_between(double t, float t_min, float t_max) {
  return t > t_min && t < t_max ? t : strictly_between(static_cast<float>(t), t_min, t_max);
}

/// The length that the t of a ray of a packet is counted in.
inline float unit_of(const WalkingRays& p, int i) {
  return p.has_units ? p.unit[i] : 1.f;
}

/// Where a ray of a packet met what it met, as t of the ray as it came.
inline float t_of(const Packet<InFloat>& p, int i) {
  return (p.best[i] + (p.moved ? p.shift[i] : 0.f)) / unit_of(p, i);
}
/// The same before it is rounded.
inline double t_double(const Packet<InFloat>& p, int i) {
  return (static_cast<double>(p.best[i]) + (p.moved ? p.shift[i] : 0.f)) / unit_of(p, i);
}
inline double t_double(const Packet<InDouble>& p, int i) {
  return p.nearest[i] / unit_of(p, i);
}
inline float t_of(const Packet<InDouble>& p, int i) {
  return static_cast<float>(t_double(p, i));
}

}  // namespace grelha::GRELHA_ISA
