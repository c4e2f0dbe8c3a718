#pragma once
// The volume that the rays of a packet go through in a grid: four planes
// around them, slice by slice along their major axis. After Wald, Ize, Kensler, Knoll, Parker, "Ray
// Tracing Animated Scenes using Coherent Grid Traversal", SIGGRAPH 2006.

#include "kernel/traverse/dda.hpp"
#include "kernel/traverse/ray.hpp"

namespace grelha::GRELHA_ISA {

inline constexpr int kGroups = kPacket / kWidth<VFloat>;
inline constexpr int kGroupRow = kGroups > kWidth<VFloat> ? kGroups : kWidth<VFloat>;

/// rays of the packets that larger ones fall apart into
inline constexpr int kSmall = 16;
inline constexpr int kMiddle = 64;

enum class Coherence {
  kMisses,     ///< no ray hits the grid
  kTogether,   ///< one frustum holds them
  kIncoherent  ///< they do not all make headway along one axis
};

/// In the grid's cells: K is the major axis (flipped when the rays run against it, so slices always
/// ascend), U and V the others. Between slices `from` and `to` every ray stays between lo and hi,
/// straight lines in s: a chord lies below the concave least of straight lines, and above the
/// convex greatest.
struct Frustum {
  int k, u, v;
  bool flip;
  /// of cells to what lies before them in the octant of all rays, or, where they have none in
  /// common, in any direction
  const std::uint8_t* distance;
  float from, to;
  float lo[2], lo_slope[2], hi[2], hi_slope[2];  ///< at s = from, and per slice
  float margin;                                  ///< rounding of all of these, in cells
  float steepest;                                ///< greatest |slope|, at least 1
  alignas(64) float position[kPacket];           ///< of each ray's origin along K
  alignas(64) float per_slice[kPacket];          ///< t a slice takes
  /// t at which the ray leaves the grid; -infinity: never hits it
  alignas(64) float leave[kPacket];
  /// Four planes f(x) = a xu + b xk + c, negative outside, for culling; gradient_length = length
  /// of the gradient.
  float a[4], b[4], c[4], gradient_length[4];
  /// The same planes for each group of a large packet alone; the a are those above. A group without
  /// a ray here has c = -infinity.
  bool by_group;
  alignas(64) float group_b[4][kGroupRow], group_c[4][kGroupRow],
      group_gradient_length[4][kGroupRow];
  int across[4], along[4];  ///< which of a box's sides are farthest inside each
  /// s = to_slice x + zero_slice along K; nothing that ends before `near` is hit, or of a group
  /// before `group_near`.
  float to_slice, zero_slice, near;
  int last;  ///< which of a box's sides is farthest along
  alignas(64) float group_near[kGroupRow];

  /// The axis of the grid across which planes 0, 1 (u) and 2, 3 (v) stand.
  int side(int plane) const { return plane < 2 ? u : v; }

  /// Bits of the lanes of a block for which `value(plane)` is not negative for all four planes.
  template <class Value>
  unsigned inside_mask(const Value& value) const {
    const Block o(0);
    const Mask<Block> out =
        mask_or(mask_or(value(0) < o, value(1) < o), mask_or(value(2) < o, value(3) < o));
    return ~bits(out) & ((1u << kWidth<Block>)-1u);
  }

  /// Bits of the groups for which `value(plane, first group)` is not negative for all four planes.
  template <class Value>
  std::uint64_t groups_inside(const Value& value) const {
    std::uint64_t in = 0;
    const VFloat o(0);
    for (int i = 0; i < kGroups; i += kWidth<VFloat>) {
      const Mask<VFloat> out = mask_or(mask_or(value(0, i) < o, value(1, i) < o),
                                       mask_or(value(2, i) < o, value(3, i) < o));
      in |= (~static_cast<std::uint64_t>(bits(out)) & ((std::uint64_t{1} << kWidth<VFloat>)-1))
            << i;
    }
    return in;
  }

  /// Bits of the groups with a ray that has not passed slice s when it begins.
  std::uint64_t groups_ahead(float s) const {
    std::uint64_t in = 0;
    for (int i = 0; i < kGroups; i += kWidth<VFloat>)
      in |= (static_cast<std::uint64_t>(bits(load<VFloat>(group_near + i) <= VFloat(s))) &
             ((std::uint64_t{1} << kWidth<VFloat>)-1))
            << i;
    return in;
  }
};

/// Bounds of the rays of each group on the slices `from` and `to`: least and greatest along U on
/// the first, on the last, and along V.
struct GroupBounds {
  alignas(64) float lo[kGroupRow][4], hi[kGroupRow][4];
  void clear() {
    for (int i = 0; i < kGroupRow; ++i)
      for (int j = 0; j < 4; ++j) {
        lo[i][j] = kInfinity;
        hi[i][j] = -kInfinity;
      }
  }
};

/// Bounds one packet in one grid.
class FrustumBuilder {
 public:
  FrustumBuilder(const GridView& g, const Packet& p, Frustum& f) : g_(g), p_(p), f_(f) {}

  Coherence build() {
    const int first = clip_rays();
    if (first < 0)
      return Coherence::kMisses;
    set_axes(first, steepest_axis(first));
    if (!bound_slices())
      return Coherence::kIncoherent;
    bound_sides();
    set_margin();
    if (first_ > size_ + f_.margin || last_ < -f_.margin)
      return Coherence::kMisses;
    set_planes();
    set_gradient_lengths();
    set_near();
    if (f_.by_group)
      set_group_planes();
    return Coherence::kTogether;
  }

 private:
  /// Corner of the grid in the coordinates of primitives, which planes are in.
  float corner_of(int axis) const { return p_.base ? p_.base[axis] : g_.lo_f[axis]; }

  /// Entry and exit of every ray. Returns the first that hits the grid, or -1.
  [[gnu::always_inline]] int clip_rays() {
    int first = -1;
    each_live_group(p_, [&](int i, int) {
      VFloat t0 = load<VFloat>(p_.start + i);
      VFloat t1 = load<VFloat>(p_.best + i);
      const VFloat least = min_advance(p_, i);
      for (int a = 0; a < 3; ++a) {
        const VFloat o = load<VFloat>(p_.org[a] + i);
        const VFloat inverse = VFloat(1) / with_advance(load<VFloat>(p_.dir[a] + i), least);
        clip_to_slab(VFloat(g_.lo_f[a]), VFloat(g_.hi_f[a]), o, inverse, t0, t1);
      }
      const Mask<VFloat> meets = t0 <= t1;
      store(enter_ + i, t0);
      store(f_.leave + i, select(meets, t1, VFloat(-kInfinity)));
      if (const unsigned lanes = bits(meets); lanes != 0 && first < 0)
        first = i + __builtin_ctz(lanes);
    });
    return first;
  }

  /// The axis along which a ray crosses most cells.
  int steepest_axis(int ray) const {
    const auto cells = [&](int a) { return p_.dir[a][ray] * g_.inv_cell_f[a]; };
    return largest_axis(cells(0), cells(1), cells(2));
  }

  void set_axes(int first, int axis) {
    f_.k = axis;
    f_.u = axis == 2 ? 0 : axis + 1;
    f_.v = axis == 0 ? 2 : axis - 1;
    f_.flip = p_.dir[axis][first] < 0;
    size_ = static_cast<float>(g_.n[axis]);
  }

  /// The slices between the first entry and the last exit. False when a ray makes no headway.
  [[gnu::always_inline]] bool bound_slices() {
    const int k = f_.k;
    const float sign = f_.flip ? -1.f : 1.f;
    VFloat s0(kInfinity);
    VFloat s1(-kInfinity);
    VFloat far(0);
    bool incoherent = false;
    for (int i = 0; i < kGroupRow; ++i)
      f_.group_near[i] = kInfinity;
    each_live_group(p_, [&](int i, int group) {
      const VFloat leave = load<VFloat>(f_.leave + i);
      const Mask<VFloat> meets = leave > VFloat(-kInfinity);
      const VFloat dk = load<VFloat>(p_.dir[k] + i) * VFloat(sign);
      incoherent |= any(and_not(meets, advances(i, dk)));
      VFloat at = (load<VFloat>(p_.org[k] + i) - VFloat(g_.lo_f[k])) * VFloat(g_.inv_cell_f[k]);
      if (f_.flip)
        at = VFloat(size_) - at;
      const VFloat q = dk * VFloat(g_.inv_cell_f[k]);
      store(f_.position + i, at);
      store(f_.per_slice + i, VFloat(1) / q);
      const VFloat in = select(meets, at + load<VFloat>(enter_ + i) * q, VFloat(kInfinity));
      f_.group_near[group] = lane_min(in);
      s0 = min(in, s0);
      s1 = max(select(meets, at + leave * q, VFloat(-kInfinity)), s1);
      far = max_abs(select(meets, at, VFloat(0)), far);
    });
    if (incoherent)
      return false;
    set_extent(lane_min(s0), lane_max(s1));
    farthest_ = lane_max(far);
    return true;
  }

  [[gnu::always_inline]] Mask<VFloat> advances(int i, const VFloat& dk) const {
    const VFloat du = magnitude(load<VFloat>(p_.dir[f_.u] + i));
    const VFloat dv = magnitude(load<VFloat>(p_.dir[f_.v] + i));
    return dk >= VFloat(kLeastProgress) * ((du + dv) + dk);
  }

  void set_extent(float first, float last) {
    first_ = first;
    last_ = last;
    f_.from = max(first, 0.f);
    f_.to = min(last, size_);
    if (!(f_.from <= f_.to))
      f_.to = f_.from;
    const float stay = f_.to - f_.from;
    is_degenerate_ = stay < kThinStay;
    inverse_extent_ = is_degenerate_ ? 0.f : 1.f / stay;
  }

  /// Bounds the rays along the other axes, on the first slice and on the last.
  [[gnu::always_inline]] void bound_sides() {
    // Rays apart by more than a group are culled by groups: worth it where there are many, and
    // where a group is more than a ray.
    f_.by_group = kWidth<VFloat> > 1 && __builtin_popcountll(p_.live) * kWidth<VFloat> > kSmall;
    if (f_.by_group)
      groups_.clear();
    float lo[4] = {kInfinity, kInfinity, kInfinity, kInfinity};
    float hi[4] = {-kInfinity, -kInfinity, -kInfinity, -kInfinity};
    VFloat wide(0);
    VFloat steep(1);
    AxesTaken taken;
    each_live_group(p_, [&](int i, int group) {
      const Mask<VFloat> meets = load<VFloat>(f_.leave + i) > VFloat(-kInfinity);
      const VFloat per_slice = load<VFloat>(f_.per_slice + i);
      const VFloat k_at = load<VFloat>(f_.position + i);
      const VFloat to_first = VFloat(f_.from) - k_at;
      const VFloat to_last = VFloat(f_.to) - k_at;
      const auto positions = [&](int a) {
        const VFloat inv(g_.inv_cell_f[a]);
        const VFloat at = (load<VFloat>(p_.org[a] + i) - VFloat(g_.lo_f[a])) * inv;
        const VFloat slope = (load<VFloat>(p_.dir[a] + i) * inv) * per_slice;
        wide = max_abs(select(meets, at, VFloat(0)), wide);
        steep = max_abs(select(meets, slope, VFloat(0)), steep);
        taken.add(a, bits(meets), bits(slope < VFloat(0)));
        return RayPositions{at + to_first * slope, at + to_last * slope};
      };
      const RayPositions u = positions(f_.u);
      const RayPositions v = positions(f_.v);
      const auto least = [&](const VFloat& x) { return select(meets, x, VFloat(kInfinity)); };
      const auto most = [&](const VFloat& x) { return select(meets, x, VFloat(-kInfinity)); };
      const VFloat lows[] = {least(u.first), least(u.last), least(v.first), least(v.last)};
      const VFloat highs[] = {most(u.first), most(u.last), most(v.first), most(v.last)};
      reduce_lanes(lows, TakeLeast{}, groups_.lo[group], lo);
      reduce_lanes(highs, TakeMost{}, groups_.hi[group], hi);
    });
    farthest_ = max(farthest_, lane_max(wide));
    slope_ = lane_max(steep);
    set_distance(taken);
    for (int j = 0; j < 2; ++j)
      set_side(j, lo[2 * j], lo[2 * j + 1], hi[2 * j], hi[2 * j + 1]);
  }

  /// Lanes with a ray that goes up or down along an axis.
  struct AxesTaken {
    unsigned up[3] = {}, down[3] = {};
    void add(int axis, unsigned rays, unsigned falling) {
      up[axis] |= rays & ~falling;
      down[axis] |= rays & falling;
    }
    bool both_ways(int axis) const { return up[axis] != 0 && down[axis] != 0; }
  };

  void set_distance(const AxesTaken& taken) {
    const auto bit = [](bool down, int axis) { return down ? 1u << axis : 0u; };
    const unsigned octant =
        bit(f_.flip, f_.k) | bit(taken.down[f_.u] != 0, f_.u) | bit(taken.down[f_.v] != 0, f_.v);
    const bool incoherent = taken.both_ways(f_.u) || taken.both_ways(f_.v);
    f_.distance = incoherent ? g_.distance : distances_in(g_, octant);
  }

  [[gnu::always_inline]] void set_side(int j, float lo0, float lo1, float hi0, float hi1) {
    if (is_degenerate_) {
      lo0 = lo1 = min(lo0, lo1);
      hi0 = hi1 = max(hi0, hi1);
    }
    f_.lo[j] = lo0;
    f_.lo_slope[j] = (lo1 - lo0) * inverse_extent_;
    f_.hi[j] = hi0;
    f_.hi_slope[j] = (hi1 - hi0) * inverse_extent_;
  }

  /// The error of everything above is a few roundings of numbers no larger than the farthest
  /// position times the steepest slope: of rays for the sides, of planes for culling.
  void set_margin() {
    f_.steepest = 1;
    // the grid's corner in cells: it cancels in the planes when the grid lies far from 0
    float corner = 0;
    for (int a = 0; a < 3; ++a) {
      farthest_ = max(static_cast<float>(g_.n[a]), farthest_);
      corner = max(magnitude(corner_of(a) * g_.inv_cell_f[a]), corner);
    }
    for (int j = 0; j < 2; ++j)
      f_.steepest = max(max(magnitude(f_.lo_slope[j]), magnitude(f_.hi_slope[j])), f_.steepest);
    f_.margin = kSideRounding * (farthest_ * max(slope_, f_.steepest));
    plane_rounding_ = kPlaneRounding * (corner + farthest_);
    const float pad = kPadOfBalls * g_.pad;
    cull_ = f_.margin + pad * max(g_.inv_cell_f[f_.u], g_.inv_cell_f[f_.v]);
    cull_of_slope_ = plane_rounding_ + pad * g_.inv_cell_f[f_.k];
  }

  void set_planes() {
    const int k = f_.k;
    const float ik = g_.inv_cell_f[k];
    // s = along x + start
    along_ = f_.flip ? -ik : ik;
    start_ = f_.flip ? size_ + corner_of(k) * ik : -(corner_of(k) * ik);
    const float cull = cull_ + cull_of_slope_ * f_.steepest;
    for (int j = 0; j < 2; ++j) {
      const int a = j == 0 ? f_.u : f_.v;
      const float iu = g_.inv_cell_f[a];
      const float zero = corner_of(a) * iu;
      f_.a[2 * j] = iu;
      f_.b[2 * j] = -(f_.lo_slope[j] * along_);
      f_.c[2 * j] = cull - zero - f_.lo[j] - f_.lo_slope[j] * (start_ - f_.from);
      f_.a[2 * j + 1] = -iu;
      f_.b[2 * j + 1] = f_.hi_slope[j] * along_;
      f_.c[2 * j + 1] = cull + zero + f_.hi[j] + f_.hi_slope[j] * (start_ - f_.from);
    }
  }

  void set_gradient_lengths() {
    for (int j = 0; j < 4; ++j) {
      f_.gradient_length[j] =
          square_root(f_.a[j] * f_.a[j] + f_.b[j] * f_.b[j]) * kGradientTolerance;
      f_.across[j] = (j < 2 ? f_.u : f_.v) + (f_.a[j] > 0 ? 3 : 0);
      f_.along[j] = f_.k + (f_.b[j] > 0 ? 3 : 0);
    }
  }

  void set_near() {
    const float early = (f_.margin + plane_rounding_) + kNearSlack * farthest_;
    f_.to_slice = along_;
    f_.zero_slice = start_;
    f_.near = f_.from - early;
    f_.last = f_.k + (f_.flip ? 0 : 3);
    for (int i = 0; i < kGroupRow; i += kWidth<VFloat>)
      store(f_.group_near + i, load<VFloat>(f_.group_near + i) - VFloat(early));
  }

  /// The planes of each group.
  [[gnu::always_inline]] void set_group_planes() {
    alignas(64) float lo[4][kGroupRow];
    alignas(64) float hi[4][kGroupRow];
    for (int i = 0; i < kGroupRow; ++i)
      for (int j = 0; j < 4; ++j) {
        lo[j][i] = groups_.lo[i][j];
        hi[j][i] = groups_.hi[i][j];
      }
    for (int i = 0; i < kGroups; i += kWidth<VFloat>)
      for (int j = 0; j < 2; ++j)
        set_planes_of_groups(i, j, lo + 2 * j, hi + 2 * j);
  }

  [[gnu::always_inline]] void set_planes_of_groups(int i,
                                                   int j,
                                                   const float (*lo)[kGroupRow],
                                                   const float (*hi)[kGroupRow]) {
    const VFloat nowhere(-kInfinity);
    const VFloat o(0);
    VFloat lo0 = load<VFloat>(lo[0] + i);
    VFloat lo1 = load<VFloat>(lo[1] + i);
    VFloat hi0 = load<VFloat>(hi[0] + i);
    VFloat hi1 = load<VFloat>(hi[1] + i);
    const Mask<VFloat> some = lo0 <= hi0;
    if (inverse_extent_ == 0) {
      lo0 = lo1 = min(lo0, lo1);
      hi0 = hi1 = max(hi0, hi1);
    }
    const VFloat lo_slope = select(some, (lo1 - lo0) * VFloat(inverse_extent_), o);
    const VFloat hi_slope = select(some, (hi1 - hi0) * VFloat(inverse_extent_), o);
    const VFloat steepest = max(max_abs(lo_slope, hi_slope), VFloat(1));
    const VFloat cull = VFloat(cull_) + VFloat(cull_of_slope_) * steepest;
    const float zero = corner_of(j == 0 ? f_.u : f_.v) * f_.a[2 * j];
    const float back = start_ - f_.from;
    const VFloat lo_c = cull - VFloat(zero) - lo0 - lo_slope * VFloat(back);
    const VFloat hi_c = cull + VFloat(zero) + hi0 + hi_slope * VFloat(back);
    store_group_plane(2 * j, i, o - lo_slope * VFloat(along_), select(some, lo_c, nowhere));
    store_group_plane(2 * j + 1, i, hi_slope * VFloat(along_), select(some, hi_c, nowhere));
  }

  [[gnu::always_inline]] void store_group_plane(int plane,
                                                int i,
                                                const VFloat& b,
                                                const VFloat& c) {
    const VFloat a(f_.a[plane & ~1]);
    store(f_.group_b[plane] + i, b);
    store(f_.group_c[plane] + i, c);
    store(f_.group_gradient_length[plane] + i,
          square_root(a * a + b * b) * VFloat(kGradientTolerance));
  }

  /// Along one axis, on the first slice and on the last.
  struct RayPositions {
    VFloat first, last;
  };

  const GridView& g_;
  const Packet& p_;
  Frustum& f_;
  alignas(64) float enter_[kPacket];  ///< t at which each ray comes to the grid
  GroupBounds groups_;
  float size_;            ///< slices of the grid
  float first_, last_;    ///< slice that the rays come to the grid in, and leave it from
  bool is_degenerate_;    ///< the stay has no slopes
  float inverse_extent_;  ///< 1 / stay, or 0
  float farthest_;        ///< from the grid's corner, of origins and of the grid, in cells
  float slope_;           ///< steepest of the rays, at least 1
  float plane_rounding_;  ///< of planes, in cells, by their slopes
  float cull_;            ///< error bound of a plane in culling, in cells
  float cull_of_slope_;   ///< the same, times the plane's slope
  float along_;           ///< s = along x + start
  float start_;
};

/// Computes entry and exit of every ray, then the frustum around the rays that hit the grid, along
/// the axis on which the first such ray crosses most cells.
inline Coherence bound_rays(const GridView& g, const Packet& p, Frustum& f) {
  return FrustumBuilder(g, p, f).build();
}

}  // namespace grelha::GRELHA_ISA
