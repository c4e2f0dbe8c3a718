#pragma once
// A packet through a grid: all rays together, slice by slice along their major axis, between four
// bounding planes. After Wald, Ize, Kensler, Knoll, Parker, "Ray Tracing Animated Scenes using
// Coherent Grid Traversal", SIGGRAPH 2006.

#include "kernel/trace/abreast.hpp"

namespace grelha::GRELHA_ISA {

/// Primitives a packet has already been tested against: a small table that may forget and is never
/// wrong.
struct Mailbox {
  static constexpr unsigned kSize = 128;
  alignas(64) std::uint32_t held[kSize];
  void clear() {
    // memset would be a slow call for so few
    const Words<Lanes> none = Words<Lanes>{} + kNoPrimitive;
    for (unsigned i = 0; i < kSize; i += kWidth<Lanes>)
      store_words(held + i, none);
  }
  bool seen(std::uint32_t id) {
    std::uint32_t& slot = held[id % kSize];
    if (slot == id)
      return true;
    slot = id;
    return false;
  }
};

inline constexpr int kGroups = kPacket / kWidth<Lanes>,
                     kGroupRow = kGroups > kWidth<Lanes> ? kGroups : kWidth<Lanes>;

/// The volume a packet marches through, in the grid's cells: K is the major axis (flipped when the
/// rays run against it, so slices always ascend), U and V the others. Between slices `from` and
/// `to` every ray stays between lo and hi, straight lines in s: a chord lies below the concave
/// least of straight lines, and above the convex greatest.
struct Frustum {
  int k, u, v;
  bool flip;
  float from, to;
  float lo[2], lo_slope[2], hi[2], hi_slope[2];  ///< at s = from, and per slice
  float margin;                                  ///< rounding of all of these, in cells
  float steepest;                                ///< greatest |slope|, at least 1
  alignas(64) float position[kPacket];           ///< of each ray's origin along K
  alignas(64) float per_slice[kPacket];          ///< t a slice takes
  /// t at which the ray leaves the grid; -infinity: never meets it
  alignas(64) float leave[kPacket];
  /// Four planes f(x) = a xu + b xk + c, negative outside, for culling; reach = length of the
  /// gradient.
  float a[4], b[4], c[4], reach[4];
  /// The same planes for each group of a large packet alone; the a are those above. Of groups
  /// without a ray here c = -infinity.
  bool by_group;
  alignas(64) float group_b[4][kGroupRow], group_c[4][kGroupRow], group_reach[4][kGroupRow];
  int across[4], along[4];  ///< which of a box's sides are farthest inside each
  /// s = to_slice x + zero_slice along K; nothing that ends before `near` is met, or of a group
  /// before `group_near`.
  float to_slice, zero_slice, near;
  int last;  ///< which of a box's sides is farthest along
  alignas(64) float group_near[kGroupRow];
};

/// rays of the packets that larger ones fall apart into
inline constexpr int kSmall = 16, kMiddle = 64;

enum class Spread { kNothing, kTogether, kApart };

/// The planes of each group, from where its rays lie on the slices `from` and `to`.
inline void bound_groups(const GridView& g,
                         Frustum& f,
                         const float (&lo0)[2][kGroupRow],
                         const float (&lo1)[2][kGroupRow],
                         const float (&hi0)[2][kGroupRow],
                         const float (&hi1)[2][kGroupRow],
                         float farthest,
                         float along,
                         float back,
                         float per) {
  const Lanes nowhere(-kInfinity), o(0);
  for (int i = 0; i < kGroups; i += kWidth<Lanes>)
    for (int j = 0; j < 2; ++j) {
      Lanes l0 = load<Lanes>(lo0[j] + i), l1 = load<Lanes>(lo1[j] + i),
            h0 = load<Lanes>(hi0[j] + i), h1 = load<Lanes>(hi1[j] + i);
      const Mask<Lanes> some = l0 <= h0;
      if (per == 0) {
        l0 = l1 = lesser(l0, l1);
        h0 = h1 = greater(h0, h1);
      }
      const Lanes lo_slope = select(some, (l1 - l0) * Lanes(per), o),
                  hi_slope = select(some, (h1 - h0) * Lanes(per), o);
      const Lanes steepest = greater(greater(magnitude(lo_slope), magnitude(hi_slope)), Lanes(1));
      const Lanes cull = Lanes(f.margin) + Lanes(1e-6f * farthest) * steepest;
      const float zero = g.lo_f[j == 0 ? f.u : f.v] * f.a[2 * j];
      const Lanes b0 = o - lo_slope * Lanes(along), b1 = hi_slope * Lanes(along), a(f.a[2 * j]);
      store(f.group_b[2 * j] + i, b0), store(f.group_b[2 * j + 1] + i, b1);
      store(f.group_c[2 * j] + i,
            select(some, cull - Lanes(zero) - l0 - lo_slope * Lanes(back), nowhere));
      store(f.group_c[2 * j + 1] + i,
            select(some, cull + Lanes(zero) + h0 + hi_slope * Lanes(back), nowhere));
      store(f.group_reach[2 * j] + i, square_root(a * a + b0 * b0) * Lanes(1.00001f));
      store(f.group_reach[2 * j + 1] + i, square_root(a * a + b1 * b1) * Lanes(1.00001f));
    }
}

/// Bits of the groups for which `value(plane, first group)` is not negative for all four planes.
template <class Value>
inline std::uint64_t groups_inside(const Value& value) {
  std::uint64_t in = 0;
  const Lanes o(0);
  for (int i = 0; i < kGroups; i += kWidth<Lanes>) {
    const Mask<Lanes> out =
        either(either(value(0, i) < o, value(1, i) < o), either(value(2, i) < o, value(3, i) < o));
    in |= (~static_cast<std::uint64_t>(bits(out)) & ((std::uint64_t{1} << kWidth<Lanes>)-1)) << i;
  }
  return in;
}

/// Entry and exit of every ray, then the frustum around those that meet the grid, along the axis on
/// which the first of them crosses most cells; or, with `axis`, around all of them along that one,
/// whether they meet the grid themselves or pass it by on both sides. kApart when not all of them
/// make headway along it.
inline Spread bound(const GridView& g, const Packet& p, Frustum& f, int axis = -1) {
  alignas(64) float enter[kPacket];
  int first = -1;
  each_live_group(p, [&](int i, int) {
    Lanes t0 = load<Lanes>(p.start + i), t1 = load<Lanes>(p.best + i);
    const Lanes least = least_headway(p, i);
    for (int a = axis < 0 ? 0 : axis; a < (axis < 0 ? 3 : axis + 1); ++a) {
      const Lanes d = load<Lanes>(p.dir[a] + i), o = load<Lanes>(p.org[a] + i);
      const Lanes inv = Lanes(1) / select(magnitude(d) < least, least, d);
      const Lanes x = (Lanes(g.lo_f[a]) - o) * inv, y = (Lanes(g.hi_f[a]) - o) * inv;
      t0 = greater(lesser(x, y), t0);
      t1 = lesser(greater(x, y), t1);
    }
    const Mask<Lanes> meets = t0 <= t1;
    store(enter + i, t0);
    store(f.leave + i, select(meets, t1, Lanes(-kInfinity)));
    if (const unsigned lanes = bits(meets); lanes != 0 && first < 0)
      first = i + __builtin_ctz(lanes);
  });
  if (first < 0)
    return Spread::kNothing;
  if (axis >= 0)
    each_live_group(p, [&](int i, int) {
      const Mask<Lanes> ray = load<Lanes>(p.best + i) > load<Lanes>(p.t_min + i);
      store(f.leave + i,
            select(
                ray, greater(load<Lanes>(f.leave + i), load<Lanes>(enter + i)), Lanes(-kInfinity)));
    });

  int k = axis < 0 ? 0 : axis;
  float most = -1;
  for (int a = 0; a < 3 && axis < 0; ++a)
    if (const float m = magnitude(p.dir[a][first] * g.inv_cell_f[a]); m > most) {
      most = m;
      k = a;
    }
  f.k = k;
  f.u = k == 2 ? 0 : k + 1;
  f.v = k == 0 ? 2 : k - 1;
  f.flip = p.dir[k][first] < 0;
  const float sign = f.flip ? -1.f : 1.f, size = static_cast<float>(g.n[k]);

  Lanes s0(kInfinity), s1(-kInfinity), far(0);
  bool apart = false;
  for (int i = 0; i < kGroupRow; ++i)
    f.group_near[i] = kInfinity;
  each_live_group(p, [&](int i, int group) {
    const Lanes leave = load<Lanes>(f.leave + i);
    const Mask<Lanes> meets = leave > Lanes(-kInfinity);
    const Lanes dk = load<Lanes>(p.dir[k] + i) * Lanes(sign);
    const Lanes du = magnitude(load<Lanes>(p.dir[f.u] + i)),
                dv = magnitude(load<Lanes>(p.dir[f.v] + i));
    apart |= any(but_not(meets, dk >= Lanes(.15f) * ((du + dv) + dk)));
    Lanes at = (load<Lanes>(p.org[k] + i) - Lanes(g.lo_f[k])) * Lanes(g.inv_cell_f[k]);
    if (f.flip)
      at = Lanes(size) - at;
    const Lanes q = dk * Lanes(g.inv_cell_f[k]);
    store(f.position + i, at);
    store(f.per_slice + i, Lanes(1) / q);
    const Lanes in = select(meets, at + load<Lanes>(enter + i) * q, Lanes(kInfinity));
    f.group_near[group] = lane_min(in);
    s0 = lesser(in, s0);
    s1 = greater(select(meets, at + leave * q, Lanes(-kInfinity)), s1);
    far = greater(select(meets, magnitude(at), Lanes(0)), far);
  });
  if (apart)
    return Spread::kApart;
  f.from = greater(lane_min(s0), 0.f);
  f.to = lesser(lane_max(s1), size);
  if (!(f.from <= f.to))
    f.to = f.from;

  float farthest = lane_max(far);
  const float span = f.to - f.from, per = span < 1e-3f ? 0.f : 1.f / span;
  // Rays apart by more than a group are culled by groups: worth it where there are many, and where
  // a group is more than a ray.
  f.by_group = kWidth<Lanes> > 1 && __builtin_popcountll(p.live) * kWidth<Lanes> > kSmall;
  alignas(64) float lo0[2][kGroupRow], lo1[2][kGroupRow], hi0[2][kGroupRow], hi1[2][kGroupRow];
  if (f.by_group)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < kGroupRow; ++i) {
        lo0[j][i] = lo1[j][i] = kInfinity;
        hi0[j][i] = hi1[j][i] = -kInfinity;
      }
  for (int j = 0; j < 2; ++j) {
    const int a = j == 0 ? f.u : f.v;
    Lanes l0s(kInfinity), l1s(kInfinity), h0s(-kInfinity), h1s(-kInfinity), wide(0);
    each_live_group(p, [&](int i, int group) {
      const Mask<Lanes> meets = load<Lanes>(f.leave + i) > Lanes(-kInfinity);
      const Lanes at = (load<Lanes>(p.org[a] + i) - Lanes(g.lo_f[a])) * Lanes(g.inv_cell_f[a]);
      const Lanes slope =
          (load<Lanes>(p.dir[a] + i) * Lanes(g.inv_cell_f[a])) * load<Lanes>(f.per_slice + i);
      const Lanes k_at = load<Lanes>(f.position + i);
      const Lanes x0 = at + (Lanes(f.from) - k_at) * slope, x1 = at + (Lanes(f.to) - k_at) * slope;
      const Lanes least0 = select(meets, x0, Lanes(kInfinity)),
                  least1 = select(meets, x1, Lanes(kInfinity));
      const Lanes most0 = select(meets, x0, Lanes(-kInfinity)),
                  most1 = select(meets, x1, Lanes(-kInfinity));
      l0s = lesser(least0, l0s);
      l1s = lesser(least1, l1s);
      h0s = greater(most0, h0s);
      h1s = greater(most1, h1s);
      wide = greater(select(meets, magnitude(at), Lanes(0)), wide);
      if (f.by_group) {
        lo0[j][group] = lane_min(least0);
        lo1[j][group] = lane_min(least1);
        hi0[j][group] = lane_max(most0);
        hi1[j][group] = lane_max(most1);
      }
    });
    farthest = greater(farthest, lane_max(wide));
    float l0 = lane_min(l0s), l1 = lane_min(l1s), h0 = lane_max(h0s), h1 = lane_max(h1s);
    if (span < 1e-3f) {
      l0 = l1 = lesser(l0, l1);
      h0 = h1 = greater(h0, h1);
    }
    f.lo[j] = l0;
    f.lo_slope[j] = (l1 - l0) * per;
    f.hi[j] = h0;
    f.hi_slope[j] = (h1 - h0) * per;
  }

  // Everything above is a few roundings of numbers no larger than `size of the scene in cells *
  // slope`.
  f.steepest = 1;
  // the grid's corner in cells: what cancels in the planes below when the grid lies far from 0
  float corner = 0;
  for (int a = 0; a < 3; ++a) {
    farthest = greater(static_cast<float>(g.n[a]), farthest);
    corner = greater(magnitude(g.lo_f[a] * g.inv_cell_f[a]), corner);
  }
  for (int j = 0; j < 2; ++j)
    f.steepest = greater(greater(magnitude(f.lo_slope[j]), magnitude(f.hi_slope[j])), f.steepest);
  f.margin = 1e-3f + 1e-6f * (farthest * f.steepest);

  const float cull = f.margin + 1e-6f * ((corner + farthest) * f.steepest), ik = g.inv_cell_f[k];
  // s = along x + start
  const float along = f.flip ? -ik : ik, start = f.flip ? size + g.lo_f[k] * ik : -(g.lo_f[k] * ik);
  for (int j = 0; j < 2; ++j) {
    const int a = j == 0 ? f.u : f.v;
    const float iu = g.inv_cell_f[a], zero = g.lo_f[a] * iu;
    f.a[2 * j] = iu, f.b[2 * j] = -(f.lo_slope[j] * along);
    f.c[2 * j] = cull - zero - f.lo[j] - f.lo_slope[j] * (start - f.from);
    f.a[2 * j + 1] = -iu, f.b[2 * j + 1] = f.hi_slope[j] * along;
    f.c[2 * j + 1] = cull + zero + f.hi[j] + f.hi_slope[j] * (start - f.from);
  }
  for (int j = 0; j < 4; ++j) {
    f.reach[j] = square_root(f.a[j] * f.a[j] + f.b[j] * f.b[j]) * 1.00001f;
    f.across[j] = (j < 2 ? f.u : f.v) + (f.a[j] > 0 ? 3 : 0);
    f.along[j] = k + (f.b[j] > 0 ? 3 : 0);
  }
  // A hit's t is off by up to 46 u of its distance (docs/numerics.md), which is at most 2 sqrt 3
  // times the farthest: 9.5e-6.
  const float early = cull + 1.2e-5f * farthest;
  f.to_slice = along;
  f.zero_slice = start;
  f.near = f.from - early;
  f.last = k + (f.flip ? 0 : 3);
  for (int i = 0; i < kGroupRow; i += kWidth<Lanes>)
    store(f.group_near + i, load<Lanes>(f.group_near + i) - Lanes(early));
  if (f.by_group)
    bound_groups(g, f, lo0, lo1, hi0, hi1, corner + farthest, along, start - f.from, per);
  return Spread::kTogether;
}

/// Rows and columns of cells the packet can touch between slices s and s + 1; false when it is
/// outside the grid there.
inline bool rectangle(
    const GridView& g, const Frustum& f, int slice, int (&least)[2], int (&most)[2]) {
  const float s = static_cast<float>(slice), next = s + 1;
  const float s0 = (s > f.from ? s : f.from) - f.from, s1 = (next < f.to ? next : f.to) - f.from;
  for (int j = 0; j < 2; ++j) {
    const float lo = lesser(f.lo[j] + s0 * f.lo_slope[j], f.lo[j] + s1 * f.lo_slope[j]) - f.margin;
    const float hi = greater(f.hi[j] + s0 * f.hi_slope[j], f.hi[j] + s1 * f.hi_slope[j]) + f.margin;
    const int n = g.n[j == 0 ? f.u : f.v];
    if (!(hi >= 0) || !(lo <= static_cast<float>(n)))
      return false;
    least[j] = clamp_cell(static_cast<double>(lo), n);
    most[j] = clamp_cell(static_cast<double>(hi), n);
  }
  return true;
}

/// Bits of the lanes of a block for which `value(plane)` is not negative for all four planes of the
/// frustum.
template <class Value>
inline unsigned inside_planes(const Value& value) {
  const Block o(0);
  const Mask<Block> out =
      either(either(value(0) < o, value(1) < o), either(value(2) < o, value(3) < o));
  return ~bits(out) & ((1u << kWidth<Block>)-1u);
}

/// Bits of the groups with a ray that has not passed slice s when it begins.
inline std::uint64_t groups_ahead(const Frustum& f, float s) {
  std::uint64_t in = 0;
  for (int i = 0; i < kGroups; i += kWidth<Lanes>)
    in |= (static_cast<std::uint64_t>(bits(load<Lanes>(f.group_near + i) <= Lanes(s))) &
           ((std::uint64_t{1} << kWidth<Lanes>)-1))
          << i;
  return in;
}

/// Bits of the boxes that reach into the frustum.
inline unsigned boxes_inside(const Frustum& f, const BlockBoxes& boxes) {
  unsigned inside = 0;
  for (int i = 0; i < kBlock; i += kWidth<Block>)
    inside |= inside_planes([&](int j) {
                return (Block(f.a[j]) * load<Block>(boxes.side[f.across[j]] + i) +
                        Block(f.b[j]) * load<Block>(boxes.side[f.along[j]] + i)) +
                       Block(f.c[j]);
              })
              << i;
  unsigned ahead = 0;
  for (int i = 0; i < kBlock; i += kWidth<Block>)
    ahead |= bits(Block(f.to_slice) * load<Block>(boxes.side[f.last] + i) + Block(f.zero_slice) >=
                  Block(f.near))
             << i;
  return inside & ahead;
}

/// Lanes of triangles i, i + 1, ... of a block that reach into the frustum.
inline unsigned triangles_inside(const Frustum& f, const TriangleBlock& block, int i) {
  const Block au = load<Block>(block.a[f.u] + i), av = load<Block>(block.a[f.v] + i),
              ak = load<Block>(block.a[f.k] + i);
  const Block bu = load<Block>(block.b[f.u] + i), bv = load<Block>(block.b[f.v] + i),
              bk = load<Block>(block.b[f.k] + i);
  const Block cu = load<Block>(block.c[f.u] + i), cv = load<Block>(block.c[f.v] + i),
              ck = load<Block>(block.c[f.k] + i);
  const unsigned left = inside_planes([&](int j) {  // the corner farthest inside
    const Block s(f.a[j]), r(f.b[j]);
    const Block fa = s * (j < 2 ? au : av) + r * ak, fb = s * (j < 2 ? bu : bv) + r * bk,
                fc = s * (j < 2 ? cu : cv) + r * ck;
    return greater(greater(fa, fb), fc) + Block(f.c[j]);
  });
  const Block s(f.to_slice);
  const Mask<Block> ahead =
      greater(greater(s * ak, s * bk), s * ck) + Block(f.zero_slice) >= Block(f.near);
  return left & bits(both(ahead, au == au));  // padding is NaN
}

template <bool kAny>
inline void test_block(
    const Frustum& f, Packet& p, const TriangleBlock& block, Mailbox* mailbox, Counters& n) {
  for (int i = 0; i < kBlock; i += kWidth<Block>) {
    for (unsigned left = triangles_inside(f, block, i); left != 0; left &= left - 1) {
      const int at = i + __builtin_ctz(left);
      const std::uint32_t id = block.id[at];
      if (mailbox && mailbox->seen(id))
        continue;
      const float a[3] = {block.a[0][at], block.a[1][at], block.a[2][at]};
      const float b[3] = {block.b[0][at], block.b[1][at], block.b[2][at]};
      const float c[3] = {block.c[0][at], block.c[1][at], block.c[2][at]};
      const std::uint64_t live = p.live;
      if (f.by_group) {
        const float end =
            greater(greater(f.to_slice * a[f.k], f.to_slice * b[f.k]), f.to_slice * c[f.k]) +
            f.zero_slice;
        p.live &= groups_ahead(f, end);
        p.live &= groups_inside([&](int j, int first) {
          const int u = j < 2 ? f.u : f.v;
          const Lanes s = load<Lanes>(f.group_b[j] + first);
          const Lanes fa = Lanes(f.a[j] * a[u]) + s * Lanes(a[f.k]),
                      fb = Lanes(f.a[j] * b[u]) + s * Lanes(b[f.k]);
          const Lanes fc = Lanes(f.a[j] * c[u]) + s * Lanes(c[f.k]);
          return greater(greater(fa, fb), fc) + load<Lanes>(f.group_c[j] + first);
        });
      }
      if (p.live != 0) {
        count_lanes(p, n, n.triangle);
        test_triangle<kAny>(p, a, b, c, id);
      }
      p.live = live;
    }
  }
}

template <bool kAny>
inline void test_triangles(const Frustum& f,
                           Packet& p,
                           const CellLists& lists,
                           std::size_t cell,
                           Mailbox* mailbox,
                           Counters& n) {
  const std::uint32_t first = lists.triangle_first[cell], end = lists.triangle_first[cell + 1];
  for (std::uint32_t at = first / kBlock * kBlock; at < end; at += kBlock)
    for (unsigned left = boxes_inside(f, lists.boxes[at / kBlock]) & blocks_between(at, first, end);
         left != 0;
         left &= left - 1)
      test_block<kAny>(
          f, p, lists.triangles[at + static_cast<unsigned>(__builtin_ctz(left))], mailbox, n);
}

/// Lanes of spheres i, i + 1, ... before `end` that reach into the frustum.
inline unsigned spheres_inside(const Frustum& f,
                               const CellLists& lists,
                               std::uint32_t i,
                               std::uint32_t end) {
  const float* const at[3] = {lists.sx, lists.sy, lists.sz};
  const Block u = load<Block>(at[f.u] + i), v = load<Block>(at[f.v] + i),
              k = load<Block>(at[f.k] + i);
  const Block r = magnitude(load<Block>(lists.sr + i));
  const unsigned left = inside_planes([&](int j) {
    return ((Block(f.a[j]) * (j < 2 ? u : v) + Block(f.b[j]) * k) + Block(f.c[j])) +
           r * Block(f.reach[j]);
  });
  return end - i < static_cast<unsigned>(kWidth<Block>) ? left & ((1u << (end - i)) - 1u) : left;
}

template <bool kAny>
inline void test_spheres(const Frustum& f,
                         Packet& p,
                         const CellLists& lists,
                         std::size_t cell,
                         Mailbox* mailbox,
                         Counters& n) {
  const std::uint32_t end = lists.sphere_first[cell + 1];
  for (std::uint32_t i = lists.sphere_first[cell]; i < end; i += kWidth<Block>) {
    for (unsigned left = spheres_inside(f, lists, i, end); left != 0; left &= left - 1) {
      const std::uint32_t s = i + static_cast<unsigned>(__builtin_ctz(left)),
                          id = lists.sphere_id[s];
      if (mailbox && mailbox->seen(id))
        continue;
      const float center[3] = {lists.sx[s], lists.sy[s], lists.sz[s]},
                  radius = magnitude(lists.sr[s]);
      const std::uint64_t live = p.live;
      if (f.by_group)
        p.live &= groups_inside([&](int j, int first) {
          const Lanes across = Lanes(f.a[j] * center[j < 2 ? f.u : f.v]) +
                               load<Lanes>(f.group_b[j] + first) * Lanes(center[f.k]);
          return (across + load<Lanes>(f.group_c[j] + first)) +
                 Lanes(radius) * load<Lanes>(f.group_reach[j] + first);
        });
      if (p.live != 0) {
        count_lanes(p, n, n.sphere);
        test_sphere<kAny>(p, center[0], center[1], center[2], lists.sr[s], id);
      }
      p.live = live;
    }
  }
}

/// Lanes of cones i, i + 1, ... before `end` that may reach into the frustum: a cone lies in the
/// hull of the balls around its two ends.
inline unsigned cones_inside(const Frustum& f,
                             const CellLists& lists,
                             std::uint32_t i,
                             std::uint32_t end) {
  const auto at = [&](int k) { return load<Block>(lists.cone[k] + i); };
  const Block h = at(6), r0 = at(7), r1 = r0 + at(8) * h;
  const Block u0 = at(f.u), v0 = at(f.v), k0 = at(f.k);
  const Block u1 = u0 + h * at(3 + f.u), v1 = v0 + h * at(3 + f.v), k1 = k0 + h * at(3 + f.k);
  const unsigned left = inside_planes([&](int j) {
    const Block s(f.a[j]), q(f.b[j]), reach(f.reach[j]);
    const Block base = (s * (j < 2 ? u0 : v0) + q * k0) + r0 * reach,
                apex = (s * (j < 2 ? u1 : v1) + q * k1) + r1 * reach;
    return greater(base, apex) + Block(f.c[j]);
  });
  return end - i < static_cast<unsigned>(kWidth<Block>) ? left & ((1u << (end - i)) - 1u) : left;
}

template <bool kAny>
inline void test_cones(const Frustum& f,
                       Packet& p,
                       const CellLists& lists,
                       std::size_t cell,
                       Mailbox* mailbox,
                       Counters& n) {
  const std::uint32_t end = lists.cone_first[cell + 1];
  for (std::uint32_t i = lists.cone_first[cell]; i < end; i += kWidth<Block>) {
    for (unsigned left = cones_inside(f, lists, i, end); left != 0; left &= left - 1) {
      const std::uint32_t c = i + static_cast<unsigned>(__builtin_ctz(left)), id = lists.cone_id[c];
      if (mailbox && mailbox->seen(id))
        continue;
      count_lanes(p, n, n.cone);
      test_cone<kAny>(p, lists.cone, c, id);
    }
  }
}

/// Leaves live those groups with a ray whose answer may still change beyond t(s), s a plane along
/// K. Returns how many such rays there are.
inline int update_live(const Frustum& f, Packet& p, float s) {
  std::uint64_t live = 0;
  int rays = 0;
  each_live_group(p, [&](int i, int g) {
    const Lanes t = (Lanes(s) - load<Lanes>(f.position + i)) * load<Lanes>(f.per_slice + i);
    const unsigned on = bits(lesser(load<Lanes>(p.best + i), load<Lanes>(f.leave + i)) > t);
    if (on != 0)
      live |= std::uint64_t{1} << g;
    rays += __builtin_popcount(on);
  });
  p.live = live;
  return rays;
}

/// The live rays of a packet, `width` at most, through one grid, each from p.start on, as far as
/// they go together. Returns the groups whose rays are to go on by themselves, from p.start on. On
/// return `live` is what it was.
template <bool kAny>
inline std::uint64_t march_from(
    const GridView& g, Packet& p, int width, bool use_mailbox, Counters& n) {
  const std::uint64_t live = p.live;
  Frustum f;
  // what does not go together in one packet may in four; what does not in these goes ray by ray
  const auto part = [&] {
    ++n.fell_back;
    if (width <= kSmall)
      return live;
    const int rays = width > kMiddle ? kMiddle : kSmall, each = rays / kWidth<Lanes>;
    std::uint64_t apart = 0;
    for (int first = 0; first < p.groups; first += each)
      if ((p.live = live & ((std::uint64_t{1} << each) - 1) << first) != 0)
        apart |= march_from<kAny>(g, p, rays, use_mailbox, n);
    p.live = live;
    return apart;
  };
  switch (bound(g, p, f)) {
    case Spread::kNothing:
      return 0;
    case Spread::kApart:
      return part();
    case Spread::kTogether:
      break;
  }
  Mailbox mailbox;
  if (use_mailbox)
    mailbox.clear();
  Mailbox* const box = use_mailbox ? &mailbox : nullptr;
  const int nk = g.n[f.k];
  const std::size_t stride[3] = {
      1,
      static_cast<std::size_t>(g.n[0]),
      static_cast<std::size_t>(g.n[0]) * static_cast<std::size_t>(g.n[1])};
  // Beyond this many cells a slice, looking into each costs more than every ray walking alone
  // (measured).
  const int limit = width > kMiddle ? 32 : width > kSmall ? 16 : 8;
  int active = update_live(f, p, f.from - f.margin);
  int slice = clamp_cell(static_cast<double>(f.from - f.margin), nk);
  const int last = clamp_cell(static_cast<double>(f.to + f.margin), nk);
  for (; slice <= last && active > 0; ++slice) {
    int least[2], most[2];
    if (!rectangle(g, f, slice, least, most))
      continue;
    const long cells = static_cast<long>(most[0] - least[0] + 1) * (most[1] - least[1] + 1);
    if (cells > 1 && cells * width > static_cast<long>(limit) * active) {
      p.live = live;
      const Lanes s(static_cast<float>(slice) - f.margin);  // what lies before this is done
      each_live_group(p, [&](int i, int) {
        const Lanes t = (s - load<Lanes>(f.position + i)) * load<Lanes>(f.per_slice + i);
        const Mask<Lanes> meets = load<Lanes>(f.leave + i) > Lanes(-kInfinity);
        store(p.start + i, select(meets, greater(t, load<Lanes>(p.start + i)), Lanes(kInfinity)));
      });
      return part();
    }
    const int sk = f.flip ? nk - 1 - slice : slice;
    int nearest = 255;
    for (int v = least[1]; v <= most[1]; ++v)
      for (int u = least[0]; u <= most[0]; ++u) {
        const std::size_t cell = static_cast<std::size_t>(sk) * stride[f.k] +
                                 static_cast<std::size_t>(u) * stride[f.u] +
                                 static_cast<std::size_t>(v) * stride[f.v];
        ++n.visits;
        const int distance = g.distance[cell];
        nearest = distance < nearest ? distance : nearest;
        if (distance != 0)
          continue;
        if (g.lists.triangle_first)
          test_triangles<kAny>(f, p, g.lists, cell, box, n);
        if (g.lists.sphere_first)
          test_spheres<kAny>(f, p, g.lists, cell, box, n);
        if (g.lists.cone_first)
          test_cones<kAny>(f, p, g.lists, cell, box, n);
      }
    if (nearest == 0) {
      active = update_live(f, p, static_cast<float>(slice + 1) - f.margin);
      // nothing within nearest - 1 cells: the packet shifts sideways by at most steepest a slice
    } else if (nearest > 1) {
      slice += f.steepest > 1 ? static_cast<int>(static_cast<float>(nearest - 1) / f.steepest)
                              : nearest - 1;
    }
  }
  ++n.formed;
  p.live = live;
  return 0;
}

/// All rays of a packet through one grid, from p.start on.
template <bool kAny>
inline void march(const GridView& g, Packet& p, bool use_mailbox, bool any_triangles, Counters& n) {
  const std::uint64_t live = p.live;
  if ((p.live = march_from<kAny>(g, p, p.size, use_mailbox, n)) != 0)
    walk_apart<kAny>(g, p, any_triangles, n);
  p.live = live;
}

}  // namespace grelha::GRELHA_ISA
