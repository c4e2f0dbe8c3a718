#pragma once
// Traces the rays of a packet through a whole scene: planes and outside primitives first, then each
// grid with the remaining range of t.

#include "kernel/traverse/far_rays.hpp"
#include "kernel/traverse/round_hits.hpp"

namespace grelha::GRELHA_ISA {

/// Tests the primitives that stand in no grid since they are infinite.
template <bool kAny>
inline void test_infinite(const SceneView& scene, Packet& p, TraceCounts& n) {
  const GeometryView& g = scene.geometry;
  InfiniteShapes::for_each([&]<class Shape>() __attribute__((always_inline)) {
    const typename Shape::Arrays& all = g.of<Shape>();
    for (std::uint32_t i = 0; i < all.count; ++i)
      test_one<kAny, Shape>(p, all.fields, i, g.ids.begin(Shape::kKind) + i, n);
  });
}

/// Groups with a ray that does not surely pass by a block of triangles outside of grids; see
/// near_outside().
inline std::uint64_t groups_near_outside(const Packet& p, const BlockBoxes& boxes, int k) {
  std::uint64_t in = 0;
  each_live_group(
      p, [&](int i, int g) __attribute__((always_inline)) {
        const VFloat least = min_advance(p, i);
        VFloat enter = load<VFloat>(p.t_min + i);
        VFloat leave = load<VFloat>(p.best + i);
        Mask<VFloat> unknown = enter < VFloat(0);
        for (int a = 0; a < 3; ++a) {
          const VFloat d = load<VFloat>(p.dir[a] + i);
          unknown = mask_or(unknown, magnitude(d) < least);
          clip_to_slab(VFloat(boxes.side[a][k]),
                       VFloat(boxes.side[a + 3][k]),
                       load<VFloat>(p.org[a] + i),
                       VFloat(1) / d,
                       enter,
                       leave);
        }
        in |= std::uint64_t{any(mask_or(
                  unknown, enter <= leave * VFloat(kOutsideSlack) + VFloat(kOutsideUnderflow)))}
              << g;
      });
  return in;
}

/// Tests the triangles that lie in no grid.
template <bool kAny>
inline void test_outside(const SceneView& scene, Packet& p, TraceCounts& n) {
  const Triangle::CellList& list = scene.outside.of<Triangle>();
  const std::uint64_t live = p.live;
  for (std::uint32_t b = 0; b < list.first[1]; ++b) {
    const TriangleBlock& block = list.blocks[b];
    if (p.groups > 1 && b < kBlock)
      p.live = live & groups_near_outside(p, scene.outside_boxes, static_cast<int>(b));
    for (int i = 0; p.live != 0 && i < kBlock && block.a[0][i] == block.a[0][i]; ++i)
      test_triangle<kAny>(p, triangle_of(block, i), block.id[i], n);
    p.live = live;
  }
}

/// The few primitives that lie in no grid, each against all rays.
template <bool kAny>
inline void test_all_outside(const SceneView& scene, Packet& p, TraceCounts& n) {
  const CellLists& lists = scene.outside;
  if (lists.of<Triangle>().first)
    test_outside<kAny>(scene, p, n);
  ArrayShapes::for_each([&]<class Shape>() __attribute__((always_inline)) {
    const typename Shape::CellList& list = lists.of<Shape>();
    for (std::uint32_t i = 0; list.first && i < list.first[1]; ++i)
      test_one<kAny, Shape>(p, list.fields, i, list.id[i], n);
  });
}

/// Which of the live rays of a packet start near a grid.
struct Starts {
  bool any_near, any_far;
};

/// Lets those rays be searched from their start that start near a grid, and others from nowhere.
inline Starts set_starts(const GridView& g, Packet& p) {
  Starts starts{false, false};
  each_live_group(p, [&](int i, int) {
    Mask<VFloat> away = VFloat(0) != VFloat(0);
    for (int a = 0; a < 3; ++a) {
      const VFloat o = load<VFloat>(p.org[a] + i);
      away = mask_or(away, mask_or(o<VFloat(g.near_lo[a]), o> VFloat(g.near_hi[a])));
    }
    const VFloat start = load<VFloat>(p.t_min + i);
    const unsigned searching = bits(load<VFloat>(p.best + i) > start);
    starts.any_far |= (bits(away) & searching) != 0;
    starts.any_near |= (~bits(away) & searching) != 0;
    store(p.start + i, select(away, VFloat(kInfinity), start));
  });
  return starts;
}

/// SimdRays::error_bound of rays from a position on, for all finite primitives of a scene.
template <class Real>
inline Real error_bound_in(const SceneView& scene, const Vec3<Real>& org) {
  const auto along = [&](const Real& o, int a) {
    return max_abs(Real(scene.box_lo[a]) - o, Real(scene.box_hi[a]) - o);
  };
  const Real far = (along(org.x, 0) + along(org.y, 1)) + along(org.z, 2);
  return Real(static_cast<float>(2 * (kFarError + 1) * kUnit<float>)) * far;
}

/// t at which the first ray of a group enters a grid; infinity if it never does, or runs along a
/// plane of the grid.
template <int K>
inline float entry(const GridView& g, const RayGroup<K>& rays) {
  float t0 = rays.t_min[0];
  float t1 = kInfinity;
  for (int a = 0; a < 3; ++a)
    clip_to_slab(g.lo_f[a], g.hi_f[a], rays.org[a][0], 1 / rays.dir[a][0], t0, t1);
  return t0 <= t1 ? t0 : kInfinity;
}

/// Visits the grids, for closest hits front to back as the first ray hits them: early hits cut the
/// other searches short. Answers do not depend on the order, since ties go to the lower id.
template <bool kAny, int K, class Visit>
inline void each_grid(const SceneView& scene, const RayGroup<K>& rays, const Visit& visit) {
  const int count = scene.grid_count;
  if (kAny || count < 2) {
    for (int g = 0; g < count; ++g)
      visit(scene.grids[g]);
    return;
  }
  int order[kMostGrids];
  float at[kMostGrids];
  for (int g = 0; g < count; ++g) {
    const float t = entry(scene.grids[g], rays);
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

/// The live rays of a packet through a grid.
template <bool kAny>
inline void search_grid(const GridView& g, Packet& p, const TraceOptions& options, TraceCounts& n) {
  const Starts starts = set_starts(g, p);
  p.error_bound = g.error_bound;
  if (starts.any_near)
    traverse_packet<kAny>(g, p, options.packet, options.mailbox, n);
  if (starts.any_far)
    search_far<kAny>(g, p, options, n);
}

inline float error_bound_of(const SceneView& scene, const Packet& p) {
  VFloat most(0);
  each_live_group(
      p, [&](int i, int) { most = max(error_bound_in(scene, take_vec<VFloat>(p.org, i)), most); });
  return lane_max(most);
}

template <bool kAny>
[[gnu::noinline]] void trace_packet(const SceneView& scene,
                                    Packet& p,
                                    const TraceOptions& options,
                                    TraceCounts& n) {
  prepare(p, scene.geometry, scene.geometry.of<Triangle>().count > 0);
  test_infinite<kAny>(scene, p, n);
  if (scene.outside.of<Sphere>().first)
    p.error_bound = error_bound_of(scene, p);
  test_all_outside<kAny>(scene, p, n);
  each_grid<kAny>(scene, p, [&](const GridView& g) { search_grid<kAny>(g, p, options, n); });
}

}  // namespace grelha::GRELHA_ISA
