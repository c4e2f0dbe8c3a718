#pragma once
// Traces the rays of a packet through a whole scene: planes and outside primitives first, then each
// grid with the remaining range of t. Floats lose the way of a ray that starts far from a grid, so
// it walks in the frame of the grid: from the grid's corner, and from the point where it comes
// near, which is found in double. Cases that float tests cannot decide there are decided with the
// ray as given.

#include "kernel/traverse/packet_walk.hpp"
#include "kernel/traverse/packet.hpp"

namespace grelha::GRELHA_ISA {

inline bool starts_near(const GridView& g, const Vec3<float>& org) {
  const auto lies_near = [&](float x, int a) { return x >= g.near_lo[a] && x <= g.near_hi[a]; };
  return lies_near(org.x, 0) && lies_near(org.y, 1) && lies_near(org.z, 2);
}

/// The point where a ray comes near a grid.
struct Entry {
  float org[3];  ///< from the corner of the grid
  double shift;  ///< t at that point
};

/// A coordinate of a ray at t, relative to x.
inline double position_at(double org, double dir, double t, double x) {
  double along = 0, rest = 0, from = 0, of_from = 0, sum = 0, of_sum = 0;
  two_product(t, dir, along, rest);
  two_sum(org, -x, from, of_from);
  two_sum(along, from, sum, of_sum);
  return sum + (of_sum + (rest + of_from));
}

/// Returns false if ray i of a group, which starts far from a grid, surely does not come to it.
/// Points on its way are off by 2^-100 of it; a second look would be off by that much of the first
/// error.
template <int K>
inline bool enter_far(const GridView& g, const RayGroup<K>& rays, int i, Entry& to) {
  const float org[3] = {rays.org[0][i], rays.org[1][i], rays.org[2][i]};
  const float dir[3] = {rays.dir[0][i], rays.dir[1][i], rays.dir[2][i]};
  const double t_min = rays.t_min[i];
  const double t_max = rays.best[i];
  const DdaState<double> r = to_grid(g, org, dir);
  double t0 = -static_cast<double>(kInfinity);
  double t1 = static_cast<double>(kInfinity);
  clip_to_grid(g, r, t0, t1);
  const double slack = 0x1p-48 * max_abs(t0, t1);
  // a NaN fails these tests
  if (!(t0 <= t1 + slack) || !(t_min <= t1 + slack) || !(t_max >= t0 - slack))
    return false;
  to.shift = max(t0, t_min);
  for (int a = 0; a < 3; ++a)
    to.org[a] = static_cast<float>(position_at(org[a], dir[a], to.shift, g.lo[a]));
  return true;
}

/// Entries and exits in float: error <= kEntryError * t, which is 3 u.
inline constexpr float kEntryError = 0x1p-20f;

/// Start of a search from `shift` on: unlimited if t_min comes before the shift, else 0.
inline float begin_from(double t_min, double shift) {
  return t_min < shift ? -kInfinity : 0.f;
}

/// A grid in its own frame.
inline GridView in_grid_frame(const GridView& g) {
  GridView own = g;
  for (int a = 0; a < 3; ++a) {
    own.lo_f[a] = 0;
    own.hi_f[a] = round_up(g.cell[a] * g.n[a]);
    own.lo[a] = 0;
  }
  return own;
}

/// Copies rays that start far from a grid and come to it into the frame of the grid.
class FarRays {
 public:
  FarRays(const GridView& g, Packet& p) : p_(p) {
    Packet& w = moved_;
    w.size = p.size;
    w.groups = p.groups;
    w.has_units = false;
    w.has_slabs = false;
    static_cast<RayFrame&>(w) = grid_frame(p, g, shift_);
    w.live = 0;
    each_live_group(p, [&](int i, int group) {
      if (set_group(g, i, group))
        w.live |= std::uint64_t{1} << group;
    });
  }

  bool any() const { return moved_.live != 0; }
  Packet& packet() { return moved_; }

  /// Stores the hits, with t of the rays as given.
  template <bool kAny>
  void take_hits() {
    each_live_group(moved_, [&](int i, int) {
      for (int k = i; k < i + kWidth<VFloat>; ++k)
        if (comes_[k] && id_of(moved_.id[k]) != id_of(p_.id[k]))
          take_hit<kAny>(k);
    });
  }

 private:
  /// Rays of a group that start far from a grid and do not surely pass it by.
  static unsigned may_enter(const GridView& g, const Packet& p, int i) {
    Mask<VFloat> away = VFloat(0) != VFloat(0);
    VFloat t0 = load<VFloat>(p.t_min + i);
    VFloat t1 = load<VFloat>(p.best + i);
    const Mask<VFloat> searching = t1 > t0;
    for (int a = 0; a < 3; ++a) {
      const VFloat o = load<VFloat>(p.org[a] + i);
      const VFloat inverse = VFloat(1) / load<VFloat>(p.dir[a] + i);
      away = mask_or(away, mask_or(o<VFloat(g.near_lo[a]), o> VFloat(g.near_hi[a])));
      // NaN, of a ray along a plane, bounds nothing
      const VFloat x = (VFloat(g.lo_f[a]) - o) * inverse;
      const VFloat y = (VFloat(g.hi_f[a]) - o) * inverse;
      const Mask<VFloat> crosses = x - y == x - y;
      clip_to_slab(select(crosses, min(x, y), t0), select(crosses, max(x, y), t1), t0, t1);
    }
    const VFloat entry_error = VFloat(kEntryError) * max_abs(t0, t1);
    return bits(
        mask_and(mask_and(away, searching), and_not(away, t0 - entry_error > t1 + entry_error)));
  }

  bool set_group(const GridView& g, int i, int group) {
    Packet& w = moved_;
    bool some = false;
    const unsigned lanes = may_enter(g, p_, i);
    if (lanes == 0)
      return false;
    for (int k = i; k < i + kWidth<VFloat>; ++k) {
      Entry to{};
      const bool comes = (lanes >> (k - i) & 1) && enter_far(g, p_, k, to);
      comes_[k] = comes;
      some |= comes;
      shift_[k] = to.shift;
      for (int a = 0; a < 3; ++a)
        w.org[a][k] = to.org[a];
      w.t_min[k] = w.start[k] = begin_from(p_.t_min[k], to.shift);
      w.best[k] = comes ? round_t_up(p_.best[k], to.shift) : -kInfinity;
      w.low[k] = round_t_down(p_.low[k], to.shift);
    }
    if (some)
      copy_group(i, group);
    return some;
  }

  void copy_group(int i, int group) {
    const auto copy = [i](const float* from, float* to) { store(to + i, load<VFloat>(from + i)); };
    Packet& w = moved_;
    w.group_axis[group] = p_.group_axis[group];
    copy(p_.id, w.id);
    copy(p_.axis, w.axis);
    copy(p_.inv_dd, w.inv_dd);
    copy(p_.inv_length, w.inv_length);
    for (int a = 0; a < 3; ++a) {
      copy(p_.dir[a], w.dir[a]);
      copy(p_.shear[a], w.shear[a]);
    }
  }

  template <bool kAny>
  void take_hit(int k) {
    p_.id[k] = moved_.id[k];
    p_.best[k] = kAny ? -kInfinity : round_t_up(moved_.best[k], -shift_[k]);
    p_.low[k] = kAny ? -kInfinity : round_t_down(moved_.low[k], -shift_[k]);
  }

  Packet& p_;
  Packet moved_;
  alignas(64) double shift_[kPacket];
  bool comes_[kPacket];
};

/// The live rays of a packet that start far from a grid.
template <bool kAny>
[[gnu::noinline]] void search_far(const GridView& g,
                                  Packet& p,
                                  const TraceOptions& options,
                                  TraceCounts& n) {
  FarRays rays(g, p);
  if (rays.any()) {
    traverse_packet<kAny>(in_grid_frame(g), rays.packet(), options.packet, options.mailbox, n);
    rays.template take_hits<kAny>();
  }
}

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
