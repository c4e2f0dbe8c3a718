#pragma once
// Takes a packet through a grid: all rays together, slice by slice along their major axis, between
// four bounding planes (frustum.hpp).

#include "kernel/grid/view.hpp"
#include "kernel/base/lanes.hpp"
#include "kernel/traverse/frustum.hpp"
#include "kernel/traverse/stream_walk.hpp"

namespace grelha::GRELHA_ISA {

/// Primitives a packet has already been tested against: a small table that may forget and is never
/// wrong.
struct Mailbox {
  static constexpr unsigned kSize = 128;
  alignas(64) std::uint32_t held[kSize];
  void clear() {
    // memset would be a slow call for so few
    const Words<VFloat> none = Words<VFloat>{} + kNoPrimitive;
    for (unsigned i = 0; i < kSize; i += kWidth<VFloat>)
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

/// Bits of the boxes that overlap the frustum.
inline unsigned boxes_inside(const Frustum& f, const BlockBoxes& boxes) {
  unsigned inside = 0;
  for (int i = 0; i < kBlock; i += kWidth<Block>)
    inside |= f.inside_mask([&](int j) {
      return (Block(f.a[j]) * load<Block>(boxes.side[f.across[j]] + i) +
              Block(f.b[j]) * load<Block>(boxes.side[f.along[j]] + i)) +
             Block(f.c[j]);
    }) << i;
  unsigned ahead = 0;
  for (int i = 0; i < kBlock; i += kWidth<Block>)
    ahead |= bits(Block(f.to_slice) * load<Block>(boxes.side[f.last] + i) + Block(f.zero_slice) >=
                  Block(f.near))
             << i;
  return inside & ahead;
}

/// Groups of rays that may pass box k of a row.
[[gnu::always_inline]] inline std::uint64_t groups_near_box(const Frustum& f,
                                                            const BlockBoxes& boxes,
                                                            int k) {
  const float end = f.to_slice * boxes.side[f.last][k] + f.zero_slice;
  return f.groups_ahead(end) & f.groups_inside([&](int j, int first) {
    const VFloat slope = load<VFloat>(f.group_b[j] + first);
    const VFloat along =
        max(slope * VFloat(boxes.side[f.k][k]), slope * VFloat(boxes.side[f.k + 3][k]));
    return VFloat(f.a[j] * boxes.side[f.across[j]][k]) + along + load<VFloat>(f.group_c[j] + first);
  });
}

/// Bits of the rays from i on that pass box k of a row before their search ends.
[[gnu::always_inline]] inline unsigned rays_through(const Packet& p,
                                                    int i,
                                                    const BlockBoxes& boxes,
                                                    int k) {
  VFloat enter = load<VFloat>(p.t_min + i);
  VFloat leave = load<VFloat>(p.best + i);
  for (int a = 0; a < 3; ++a) {
    const float base = p.base ? p.base[a] : 0.f;
    const VFloat org = load<VFloat>(p.org[a] + i);
    clip_to_slab(VFloat(boxes.side[a][k] - base),
                 VFloat(boxes.side[a + 3][k] - base),
                 org,
                 load<VFloat>(p.inverse[a] + i),
                 enter,
                 leave);
  }
  return bits(enter <= leave);
}

/// Lanes of primitives i, i + 1, ... that come before `end`.
inline unsigned active_before(unsigned lanes, std::uint32_t i, std::uint32_t end) {
  return end - i < static_cast<unsigned>(kWidth<Block>) ? lanes & ((1u << (end - i)) - 1u) : lanes;
}

/// Calls visit(index in the list) for each primitive of a cell that overlaps the frustum.
template <class Fields, class Visit>
[[gnu::always_inline]] inline void each_inside(const Frustum& f,
                                               const CellArrays<Fields>& list,
                                               std::size_t cell,
                                               const Visit& visit) {
  const std::uint32_t end = list.first[cell + 1];
  for (std::uint32_t i = list.first[cell]; i < end; i += kWidth<Block>) {
    unsigned left = active_before(overlapping(f, list.fields, i), i, end);
    for (; left != 0; left &= left - 1)
      visit(i + static_cast<unsigned>(__builtin_ctz(left)));
  }
}

/// Rows and columns of cells of a slice.
struct CellRect {
  int least[2], most[2];
  long cells() const {
    return static_cast<long>(most[0] - least[0] + 1) * (most[1] - least[1] + 1);
  }
};

/// Part of a slice between a frustum's first slice and its last, counted from the first.
struct SliceSpan {
  float begin, end;
};
inline SliceSpan span_of(const Frustum& f, int slice) {
  const float s = static_cast<float>(slice);
  const float next = s + 1;
  return {(s > f.from ? s : f.from) - f.from, (next < f.to ? next : f.to) - f.from};
}

struct Interval {
  float lo, hi;
};
/// Bounds of the rays along U (j = 0) or V (j = 1) within a slice, in cells.
inline Interval side_in(const Frustum& f, int j, const SliceSpan& s) {
  return {min(f.lo[j] + s.begin * f.lo_slope[j], f.lo[j] + s.end * f.lo_slope[j]) - f.margin,
          max(f.hi[j] + s.begin * f.hi_slope[j], f.hi[j] + s.end * f.hi_slope[j]) + f.margin};
}

/// The cells that a frustum can overlap between slices s and s + 1; false when it is outside the
/// grid there.
[[gnu::always_inline]] inline bool rectangle(const GridView& g,
                                             const Frustum& f,
                                             int slice,
                                             CellRect& r) {
  const SliceSpan span = span_of(f, slice);
  for (int j = 0; j < 2; ++j) {
    const auto [lo, hi] = side_in(f, j, span);
    const int n = g.n[j == 0 ? f.u : f.v];
    if (!(hi >= 0) || !(lo <= static_cast<float>(n)))
      return false;
    r.least[j] = clamp_cell(static_cast<double>(lo), n);
    r.most[j] = clamp_cell(static_cast<double>(hi), n);
  }
  return true;
}

/// Calls visit.look(cell) for the cells with something in them that lie in a rectangle of a slice.
/// Returns the least distance that a cell of it has to one before it with something in it.
template <class Visit>
[[gnu::always_inline]] inline int look_into_cells(const GridView& g,
                                                  const Frustum& f,
                                                  int slice,
                                                  const CellRect& r,
                                                  TraceCounts& n,
                                                  Visit& visit) {
  const std::size_t stride[3] = {
      1,
      static_cast<std::size_t>(g.n[0]),
      static_cast<std::size_t>(g.n[0]) * static_cast<std::size_t>(g.n[1])};
  const int k = f.flip ? g.n[f.k] - 1 - slice : slice;
  int nearest = 255;
  for (int v = r.least[1]; v <= r.most[1]; ++v)
    for (int u = r.least[0]; u <= r.most[0]; ++u) {
      const std::size_t cell = static_cast<std::size_t>(k) * stride[f.k] +
                               static_cast<std::size_t>(u) * stride[f.u] +
                               static_cast<std::size_t>(v) * stride[f.v];
      ++n.visits;
      const int distance = f.distance[cell];
      nearest = distance < nearest ? distance : nearest;
      if (distance == 0)
        visit.look(cell);
    }
  return nearest;
}

/// Slices that hold nothing after one that has nothing within nearest - 1 cells: the frustum shifts
/// sideways by at most `steepest` a slice.
inline int empty_slices(const Frustum& f, int nearest) {
  return f.steepest > 1 ? static_cast<int>(static_cast<float>(nearest - 1) / f.steepest)
                        : nearest - 1;
}

/// Goes through the slices that a frustum crosses in a grid, front to back. visit.enter(slice,
/// rectangle) comes before what visit.look(cell) sees of one, visit.leave(slice) after a slice with
/// something in it; the walk ends where one of the two returns false.
template <class Visit>
[[gnu::always_inline]] inline void walk_frustum(const GridView& g,
                                                const Frustum& f,
                                                TraceCounts& n,
                                                Visit& visit) {
  const int slices = g.n[f.k];
  int slice = clamp_cell(static_cast<double>(f.from - f.margin), slices);
  const int last = clamp_cell(static_cast<double>(f.to + f.margin), slices);
  for (; slice <= last; ++slice) {
    CellRect r;
    if (!rectangle(g, f, slice, r))
      continue;
    if (!visit.enter(slice, r))
      return;
    const int nearest = look_into_cells(g, f, slice, r, n, visit);
    if (nearest == 0) {
      if (!visit.leave(slice))
        return;
    } else if (nearest > 1) {
      slice += empty_slices(f, nearest);
    }
  }
}

/// Leaves live those groups with a ray whose answer may still change beyond t(s), s a plane along
/// K. Returns how many such rays there are.
[[gnu::always_inline]] inline int update_live(const Frustum& f, Packet& p, float s) {
  std::uint64_t live = 0;
  int rays = 0;
  each_live_group(p, [&](int i, int g) {
    const VFloat t = (VFloat(s) - load<VFloat>(f.position + i)) * load<VFloat>(f.per_slice + i);
    const unsigned on = bits(min(load<VFloat>(p.best + i), load<VFloat>(f.leave + i)) > t);
    if (on != 0)
      live |= std::uint64_t{1} << g;
    rays += __builtin_popcount(on);
  });
  p.live = live;
  return rays;
}

/// Beyond this many cells a slice, looking into each costs more than every ray walking alone
/// (measured).
inline int most_cells(int width) {
  return width > kMiddle ? 24 : width > kSmall ? 10 : 6;
}

/// Tests of a triangle against a group of rays that take as long as that of a block against one
/// ray, which costs more where a hit is more than an end; and rays that are always so tested.
template <bool kAny>
inline constexpr int kRayTest = kAny ? 2 : 4;
inline constexpr int kLeastSingleRays = 3;

/// The rays of a packet that go through a grid together.
template <bool kAny>
class PacketVisit {
 public:
  PacketVisit(
      const GridView& g, const Frustum& f, Packet& p, int width, bool mailbox, TraceCounts& n)
      : g_(g), f_(f), p_(p), n_(n), width_(width), limit_(most_cells(width)), mailbox_(mailbox) {
    if (mailbox)
      held_.clear();
  }

  bool start() {
    started_ = active_ = update_live(f_, p_, f_.from - f_.margin);
    return active_ > 0;
  }

  bool enter(int slice, const CellRect& r) {
    const long cells = r.cells();
    if (cells > 1 && cells * width_ > static_cast<long>(limit_) * active_)
      split_at_ = slice;
    return split_at_ < 0;
  }

  [[gnu::always_inline]] void look(std::size_t cell) {
    CellShapes::for_each([&]<class Shape>() __attribute__((always_inline)) {
      const typename Shape::CellList& list = g_.lists.of<Shape>();
      if (!list.first)
        return;
      if constexpr (Shape::kInBlocks)
        test_blocks(list, cell);
      else
        test_list<Shape>(list, cell);
    });
  }

  bool leave(int slice) {
    active_ = update_live(f_, p_, static_cast<float>(slice + 1) - f_.margin);
    return active_ > 0;
  }

  /// The slice before which the rays no longer had enough in common, or -1.
  int split_at() const { return split_at_; }
  /// The share of the ways of all rays that was gone until then.
  float saved() const {
    const float way = f_.to + 1 - f_.from;
    const float left = min(f_.to + 1 - static_cast<float>(split_at_), way);
    return 1 - static_cast<float>(active_) / static_cast<float>(started_) * (left / way);
  }

 private:
  bool seen(std::uint32_t id) { return mailbox_ && held_.seen(id); }

  [[gnu::noinline]] void test_blocks(const Triangle::CellList& list, std::size_t cell) {
    const std::uint32_t first = list.first[cell];
    const std::uint32_t end = list.first[cell + 1];
    for (std::uint32_t at = first / kBlock * kBlock; at < end; at += kBlock) {
      unsigned left = boxes_inside(f_, list.boxes[at / kBlock]) & blocks_between(at, first, end);
      const TriangleBlock* const blocks = list.blocks + list.block_at(at);
      for (; left != 0; left &= left - 1) {
        const int k = __builtin_ctz(left);
        test_block(list.boxes[at / kBlock], k, blocks[k]);
      }
    }
  }

  /// Tests the rays that pass a block's box one by one, its triangles side by side, if these are
  /// fewer tests than of `triangles` against groups of rays. Returns false if they are not.
  [[gnu::noinline]] bool test_rays(const BlockBoxes& boxes,
                                   int k,
                                   const TriangleBlock& block,
                                   int triangles) {
    need_slabs(p_);
    const std::uint64_t near = f_.by_group ? p_.live & groups_near_box(f_, boxes, k) : p_.live;
    unsigned lanes[kGroups];
    int rays = 0;
    int tests = kRayTest<true> * kLeastSingleRays;
    for (std::uint64_t left = near; left != 0; left &= left - 1) {
      const int g = __builtin_ctzll(left);
      lanes[g] = rays_through(p_, g * kWidth<VFloat>, boxes, k);
      rays += __builtin_popcount(lanes[g]);
      tests += lanes[g] != 0 ? triangles : 0;
      if (kRayTest<kAny> * rays > tests)
        return false;
    }
    for (std::uint64_t left = near; left != 0; left &= left - 1) {
      const int g = __builtin_ctzll(left);
      each_bit(lanes[g], [&](int lane) {
        PacketRay r{p_, g * kWidth<VFloat> + lane};
        grelha::GRELHA_ISA::test_block<kAny>(r, block);
      });
    }
    count_rows<Triangle>(n_, rays, kBlock);
    return true;
  }

  [[gnu::always_inline]] void test_block(const BlockBoxes& boxes,
                                         int k,
                                         const TriangleBlock& block) {
    unsigned inside = 0;
    for (int i = 0; i < kBlock; i += kWidth<Block>)
      inside |= overlapping(f_, block, i) << i;
    const int triangles = __builtin_popcount(inside);
    if (kAny && triangles > 1 && p_.single_ray_stats.should_try()) {
      const bool by_rays = test_rays(boxes, k, block, triangles);
      p_.single_ray_stats.record(by_rays);
      if (by_rays)
        return;
    }
    each_bit(inside, [&](int at) {
      const std::uint32_t id = block.id[at];
      if (seen(id))
        return;
      const Triangle::Fields<float> triangle = triangle_of(block, at);
      const auto test = [&] { test_triangle<kAny>(p_, triangle, id, n_); };
      test_near_groups<Triangle>(triangle, test);
    });
  }

  template <class Shape>
  void test_list(const typename Shape::CellList& list, std::size_t cell) {
    each_inside(f_, list, cell, [&](std::uint32_t i) {
      const std::uint32_t id = list.id[i];
      if (seen(id))
        return;
      const auto test = [&] { test_one<kAny, Shape>(p_, list.fields, i, id, n_); };
      test_near_groups<Shape>(broadcast<Shape, float>(list.fields, i), test);
    });
  }

  /// Runs a test against one primitive for the groups of rays that may hit it.
  template <class Shape, class Test>
  [[gnu::always_inline]] void test_near_groups(const typename Shape::template Fields<float>& one,
                                               const Test& test) {
    const std::uint64_t live = p_.live;
    if (f_.by_group)
      p_.live &= groups_near(f_, one);
    if (p_.live != 0)
      test();
    p_.live = live;
  }

  const GridView& g_;
  const Frustum& f_;
  Packet& p_;
  TraceCounts& n_;
  int width_;
  int limit_;
  int started_ = 0;
  int active_ = 0;
  int split_at_ = -1;
  bool mailbox_;
  Mailbox held_;
};

/// Lets the rays that hit the grid go on from a slice; the slices before it are done.
inline void start_from_slice(const Frustum& f, Packet& p, int slice) {
  const VFloat s(static_cast<float>(slice) - f.margin);
  each_live_group(p, [&](int i, int) {
    const VFloat t = (s - load<VFloat>(f.position + i)) * load<VFloat>(f.per_slice + i);
    const Mask<VFloat> meets = load<VFloat>(f.leave + i) > VFloat(-kInfinity);
    store(p.start + i, select(meets, max(t, load<VFloat>(p.start + i)), VFloat(kInfinity)));
  });
}

inline FrustumStats& stats_of(Packet& p, int width) {
  return width > kMiddle ? p.large_stats : width > kSmall ? p.middle_stats : p.small_stats;
}

/// Takes the live rays of a packet, `width` at most, through a grid, each from p.start on, as far
/// as they go together, if those before did. Returns false if they are to go on from p.start in
/// smaller packets. Leaves `live` unchanged on return.
template <bool kAny>
inline bool walk_together(
    const GridView& g, Packet& p, int width, bool use_mailbox, TraceCounts& n) {
  FrustumStats& stats = stats_of(p, width);
  if (!stats.should_try())
    return false;
  Frustum f;
  const Coherence coherence = bound_rays(g, p, f);
  if (coherence != Coherence::kTogether) {
    const bool misses = coherence == Coherence::kMisses;
    stats.record(misses ? 1 : 0);
    return misses;
  }
  const std::uint64_t live = p.live;
  PacketVisit<kAny> visit(g, f, p, width, use_mailbox, n);
  if (visit.start())
    walk_frustum(g, f, n, visit);
  p.live = live;
  if (visit.split_at() >= 0) {
    stats.record(visit.saved());
    start_from_slice(f, p, visit.split_at());
    return false;
  }
  stats.record(1);
  ++n.packets.formed;
  return true;
}

/// Rays of the packets that one falls apart into; 0: they go one by one.
inline int parts_of(int width) {
  return width > kMiddle ? kMiddle : width > kSmall ? kSmall : 0;
}

/// All rays of a packet through one grid, from p.start on: `width` neighbours together, then those
/// that part in smaller packets, and the rest one by one.
template <bool kAny>
inline void traverse_packet(
    const GridView& g, Packet& p, int width, bool use_mailbox, TraceCounts& n) {
  const std::uint64_t live = p.live;
  int rays = width == 1 || g.stretched ? 0 : width < p.size ? width : p.size;
  std::uint64_t unfinished = live;
  for (; rays > 0 && unfinished != 0; rays = parts_of(rays)) {
    const std::uint64_t going = unfinished;
    const int each = (rays + kWidth<VFloat> - 1) / kWidth<VFloat>;
    unfinished = 0;
    for (int first = 0; first < p.groups; first += each) {
      p.live = going & ~std::uint64_t{0} >> (64 - each) << first;
      if (p.live != 0 && !walk_together<kAny>(g, p, rays, use_mailbox, n)) {
        unfinished |= p.live;
        ++n.packets.packet_fallbacks;
      }
    }
  }
  p.live = unfinished;
  if (unfinished != 0)
    stream_traverse<kAny ? Find::kAny : Find::kClosest>(g, p, n);
  p.live = live;
}

}  // namespace grelha::GRELHA_ISA
