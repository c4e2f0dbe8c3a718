#pragma once
// Takes many rays that have nothing else in common through a grid, each on its own. All rays under
// way step side by side (SIMD over rays); then the rays that came to cells with something in them
// are tested there, each by itself (SIMD over primitives).
//
// What a ray does next cannot be predicted, nor what is in the cell it came to: so except for hits
// hardly a branch depends on one ray. Each phase goes through a list of the rays, boxes or blocks
// that the phase before it chose, and prefetches what the phase after it reads.

#include "kernel/traverse/dda.hpp"
#include "kernel/traverse/cell_tests.hpp"

namespace grelha::GRELHA_ISA {

/// Length of arrays: storing selected lanes writes a full register, past the last one.
inline constexpr int kActiveRow = kPacket + kWidth<VFloat>;

/// Rays that came to cells with something in them.
struct LeafQueue {
  int count = 0;
  alignas(64) std::uint32_t ray[kActiveRow];  ///< indices in the packet
  alignas(64) std::uint32_t cell[kActiveRow];
};

/// The rays of a packet that are still under way through a grid.
class ActiveRays {
 public:
  ActiveRays(const GridView& g, const Packet& p) : g_(g), p_(p) {
    each_live_group(p, [&](int i, int) { add(i); });
    going_ = count_;
    fill_up();
  }

  bool any() const { return going_ > 0; }
  int going() const { return going_; }

  /// Notes those whose cells hold something.
  void enqueue(LeafQueue& to) {
    to.count = 0;
    for (int i = 0; i < count_; i += kWidth<VFloat>)
      enqueue(i, to);
  }

  /// Goes on to the next cells.
  void step() {
    going_ = 0;
    for (int i = 0; i < count_; i += kWidth<VFloat>)
      step(i);
    if (2 * going_ <= count_)
      close_ranks();
  }

 private:
  void add(int i) {
    VFloat org[3];
    VFloat dir[3];
    for (int a = 0; a < 3; ++a) {
      org[a] = load<VFloat>(p_.org[a] + i);
      dir[a] = load<VFloat>(p_.dir[a] + i);
    }
    const VFloat begin = max(load<VFloat>(p_.start + i), load<VFloat>(p_.t_min + i));
    DdaState<VFloat> c;
    VFloat cell[3];
    const Mask<VFloat> come = enter(g_, org, dir, begin, load<VFloat>(p_.best + i), c, cell);
    const CompressMask selected(bits(come));
    put(selected,
        count_,
        c,
        cell,
        counted_words<VFloat>(static_cast<std::uint32_t>(i)),
        field_of(c));
    count_ += selected.count();
  }

  /// Start of the distances for the octants of rays.
  Words<VFloat> field_of(const DdaState<VFloat>& c) const {
    const VFloat o(0);
    VFloat field(1);
    for (int a = 0; a < 3; ++a)
      field = field + select(c.inverse[a] < o, VFloat(static_cast<float>(1 << a)), o);
    return g_.field_stride * to_words(field);
  }

  [[gnu::always_inline]] void put(const CompressMask& selected,
                                  int to,
                                  const DdaState<VFloat>& c,
                                  const VFloat (&cell)[3],
                                  const Words<VFloat>& ray,
                                  const Words<VFloat>& field) {
    for (int a = 0; a < 3; ++a) {
      selected.store(origin_in_cells_[a] + to, c.origin_in_cells[a]);
      selected.store(speed_[a] + to, c.speed[a]);
      selected.store(inverse_[a] + to, c.inverse[a]);
      selected.store(cell_[a] + to, cell[a]);
    }
    selected.store(end_ + to, c.end);
    selected.store(ray_ + to, ray);
    selected.store(field_ + to, field);
  }

  [[gnu::always_inline]] void enqueue(int i, LeafQueue& to) {
    const auto at = [&](int a) { return to_words(load<VFloat>(cell_[a] + i)); };
    const auto cells_along = [&](int a) { return static_cast<std::uint32_t>(g_.n[a]); };
    const Words<VFloat> cell = at(0) + cells_along(0) * (at(1) + cells_along(1) * at(2));
    const VFloat distance = bytes_at(g_.distance, load_words<VFloat>(field_ + i) + cell);
    store(distance_ + i, distance);
    const CompressMask full(bits(distance == VFloat(0)) & walking(i));
    full.store(to.ray + to.count, load_words<VFloat>(ray_ + i));
    full.store(to.cell + to.count, cell);
    to.count += full.count();
  }

  /// Bits of the lanes from i on that are under way.
  unsigned walking(int i) const {
    return bits(load<VFloat>(end_ + i) > VFloat(-kInfinity)) & active_before(i);
  }
  unsigned active_before(int i) const {
    const int left = count_ - i;
    return left >= kWidth<VFloat> ? ~0u : (1u << left) - 1u;
  }

  [[gnu::always_inline]] DdaState<VFloat> state(int i) const {
    DdaState<VFloat> c;
    for (int a = 0; a < 3; ++a) {
      c.origin_in_cells[a] = load<VFloat>(origin_in_cells_[a] + i);
      c.speed[a] = load<VFloat>(speed_[a] + i);
      c.inverse[a] = load<VFloat>(inverse_[a] + i);
    }
    c.end = load<VFloat>(end_ + i);
    return c;
  }

  [[gnu::always_inline]] void step(int i) {
    VFloat at[3];
    for (int a = 0; a < 3; ++a)
      at[a] = load<VFloat>(cell_[a] + i);
    const VFloat best = floats_at(p_.best, load_words<VFloat>(ray_ + i));
    const DdaState<VFloat> c = state(i);
    const Mask<VFloat> goes =
        grelha::GRELHA_ISA::step(g_, c, load<VFloat>(distance_ + i), best, at);
    for (int a = 0; a < 3; ++a)
      store(cell_[a] + i, select(goes, at[a], VFloat(0)));
    // only a ray that is under way has an end
    store(end_ + i, select(goes, c.end, VFloat(-kInfinity)));
    going_ += __builtin_popcount(bits(goes) & active_before(i));
  }

  void close_ranks() {
    int to = 0;
    for (int i = 0; i < count_; i += kWidth<VFloat>) {
      const CompressMask selected(walking(i));
      VFloat cell[3];
      for (int a = 0; a < 3; ++a)
        cell[a] = load<VFloat>(cell_[a] + i);
      const Words<VFloat> ray = load_words<VFloat>(ray_ + i);
      put(selected, to, state(i), cell, ray, load_words<VFloat>(field_ + i));
      to += selected.count();
    }
    count_ = to;
  }

  /// Makes lanes behind the last ray fit to be computed with; later such lanes hold old rays.
  void fill_up() {
    const int end = count_ + kWidth<VFloat>;
    for (int i = count_; i < end; ++i) {
      for (int a = 0; a < 3; ++a)
        cell_[a][i] = 0;
      end_[i] = -kInfinity;
      ray_[i] = 0;
      field_[i] = 0;
    }
  }

  const GridView& g_;
  const Packet& p_;
  int count_ = 0;
  int going_ = 0;
  alignas(64) float origin_in_cells_[3][kActiveRow];
  alignas(64) float speed_[3][kActiveRow];
  alignas(64) float inverse_[3][kActiveRow];
  alignas(64) float cell_[3][kActiveRow];
  alignas(64) float end_[kActiveRow];
  alignas(64) float distance_[kActiveRow];
  alignas(64) std::uint32_t ray_[kActiveRow];
  alignas(64) std::uint32_t field_[kActiveRow];
};

/// Prefetches an object, line by line.
template <class T>
[[gnu::always_inline]] inline void prefetch(const T* object) {
  const char* const bytes = reinterpret_cast<const char*>(object);
  for (std::size_t at = 0; at < sizeof(T); at += 64)
    __builtin_prefetch(bytes + at);
}

/// Most bytes of the fields of kinds whose primitives are prefetched: larger ones come too late.
inline constexpr std::size_t kMaxPrefetchBytes = 16;

/// Tests rays against the contents of the cells they came to.
template <Find kFind>
class CellTests {
 public:
  CellTests(const GridView& g, Packet& p, TraceCounts& n)
      : lists_(g.lists), p_(p), n_(n), pairs_(g, p) {
    if (triangles_.first)
      need_slabs(p);
  }

  void test(const LeafQueue& to) {
    if (triangles_.first)
      test_triangles(to);
    ArrayShapes::for_each([&]<class Shape>() __attribute__((always_inline)) {
      if (lists_.of<Shape>().first)
        test_arrays<Shape>(to);
    });
  }

 private:
  static constexpr bool kAny = kFind == Find::kAny;
  static constexpr int kMost = 512;  ///< blocks that are due at once

  bool searches(int ray) const { return p_.best[ray] > p_.t_min[ray]; }

  [[gnu::always_inline]] void test_triangles(const LeafQueue& to) {
    for (int k = 0; k < to.count; ++k) {
      first_[k] = triangles_.first[to.cell[k]];
      end_[k] = triangles_.first[to.cell[k] + 1];
      prefetch(triangles_.boxes + first_[k] / kBlock);
    }
    int due = 0;
    for (int k = 0; k < to.count; ++k)
      for (std::uint32_t at = first_[k] / kBlock * kBlock; at < end_[k]; at += kBlock) {
        due = take_blocks(to.ray[k], at, blocks_between(at, first_[k], end_[k]), due);
        if (due >= kMost) {
          flush(due);
          due = 0;
        }
      }
    flush(due);
  }

  /// Puts those of some blocks from `at` on whose boxes a ray passes behind those that are due.
  /// Returns how many there are then.
  [[gnu::always_inline]] int take_blocks(std::uint32_t ray,
                                         std::uint32_t at,
                                         unsigned blocks,
                                         int due) {
    const PacketRay r{p_, static_cast<int>(ray)};
    const std::uint32_t block = triangles_.block_at(at);
    ++n_.rows.boxes;
    for (int i = 0; i < kBlock; i += kWidth<Block>) {
      Block enter;
      const unsigned hit = hit_boxes_from(r, triangles_.boxes[at / kBlock], i, enter);
      const CompressMask selected(hit & blocks >> i);
      store_words(queued_ray_ + due, Words<Block>{} + ray);
      selected.store(queued_block_ + due, counted_words<Block>(block + static_cast<unsigned>(i)));
      due += selected.count();
    }
    return due;
  }

  /// Tests the blocks that are due.
  [[gnu::noinline]] void flush(int due) {
    count_rows<Triangle>(n_, due, kBlock);
    for (int k = 0; k < due && k < kPrefetch; ++k)
      prefetch(triangles_.blocks + queued_block_[k]);
    for (int k = 0; k < due; ++k) {
      const int next = k + kPrefetch < due ? k + kPrefetch : due - 1;
      prefetch(triangles_.blocks + queued_block_[next]);
      pairs_.add(queued_ray_[k], queued_block_[k]);
    }
    pairs_.test();
  }

  template <class Shape>
  [[gnu::noinline]] void test_arrays(const LeafQueue& to) {
    const typename Shape::CellList& list = lists_.of<Shape>();
    if constexpr (sizeof(typename Shape::template Fields<float>) <= kMaxPrefetchBytes)
      for (int k = 0; k < to.count; ++k)
        fetch<Shape>(list, list.first[to.cell[k]]);
    if constexpr (kFind == Find::kAll)
      for (int k = 0; k < to.count; ++k)
        list_rows<Shape>(PacketRay{p_, static_cast<int>(to.ray[k])}, list, to.cell[k]);
    else if constexpr (!kAny && kHasPrefilter<Shape>)
      test_selected_rows<Shape>(list, to);
    else
      for (int k = 0; k < to.count; ++k) {
        PacketRay r{p_, static_cast<int>(to.ray[k])};
        if (searches(r.i))
          test_list<kAny, Shape>(r, list, to.cell[k], n_);
      }
  }

  /// True if missed primitives are sorted out before the others are tested.
  template <class Shape>
  static constexpr bool kHasPrefilter =
      requires(const SimdRays<Block>& ray, const typename Shape::template Fields<Block>& row) {
    may_intersect(ray, row);
  };

  template <class Shape>
  [[gnu::always_inline]] void test_selected_rows(const typename Shape::CellList& list,
                                                 const LeafQueue& to) {
    int due = 0;
    for (int k = 0; k < to.count; ++k) {
      const SimdRays<Block> ray = spread<Block>(PacketRay{p_, static_cast<int>(to.ray[k])});
      const std::uint32_t end = list.first[to.cell[k] + 1];
      for (std::uint32_t i = list.first[to.cell[k]]; i < end; i += kWidth<Block>) {
        count_rows<Shape>(n_, 1, kWidth<Block>);
        queued_ray_[due] = to.ray[k];
        queued_block_[due] = i;
        due += any(may_intersect(ray, side_by_side<Shape, Block>(list.fields, i)));
        if (due == kMost) {
          test_rows<Shape>(list, due);
          due = 0;
        }
      }
    }
    test_rows<Shape>(list, due);
  }

  template <class Shape>
  [[gnu::always_inline]] void test_rows(const typename Shape::CellList& list, int due) {
    for (int k = 0; k < due; ++k) {
      PacketRay r{p_, static_cast<int>(queued_ray_[k])};
      if (searches(r.i))
        test_row<kAny, Shape>(r, spread<Block>(r), list, queued_block_[k]);
    }
  }

  /// Asks for what the first two blocks of primitives from `first` on are made of, and for ids: a
  /// hit is likely.
  template <class Shape>
  [[gnu::always_inline]] void fetch(const typename Shape::CellList& list, std::uint32_t first) {
    const auto prefetch_field = [first](const float* const& field) {
      __builtin_prefetch(field + first);
      __builtin_prefetch(field + first + 16);
    };
    Shape::for_each_field(prefetch_field, list.fields);
    __builtin_prefetch(list.id + first);
  }

  static constexpr int kPrefetch = 8;

  const CellLists& lists_;
  const Triangle::CellList& triangles_ = lists_.of<Triangle>();
  Packet& p_;
  TraceCounts& n_;
  std::uint32_t first_[kPacket];
  std::uint32_t end_[kPacket];
  alignas(64) std::uint32_t queued_ray_[kMost + kBlock];
  alignas(64) std::uint32_t queued_block_[kMost + kBlock];
  PairTests<kFind> pairs_;
};

/// The live rays of a packet through a grid, each from p.start on and on its own (Amanatides & Woo
/// 1987), with leaps over empty cells by their distance (Cohen & Sheffer, "Proximity Clouds",
/// 1994). A hit is never clipped to its cell; a walk ends once the hit lies at or before the exit
/// of the cell. Plane distances come from the plane's index, never by adding up; if float takes a
/// ray to the wrong side of a corner, the error is less than the pad around primitives
/// (docs/proofs.md).
template <Find kFind>
[[gnu::noinline]] void stream_traverse(const GridView& g, Packet& p, TraceCounts& n) {
  ActiveRays rays(g, p);
  if (!rays.any())
    return;
  CellTests<kFind> tests(g, p, n);
  LeafQueue leaves;
  // No walk crosses more planes than there are, whatever rounding does.
  const int most = g.n[0] + g.n[1] + g.n[2] + 3;
  for (int round = 0; round < most && rays.any(); ++round) {
    n.visits += static_cast<unsigned>(rays.going());
    rays.enqueue(leaves);
    tests.test(leaves);
    rays.step();
  }
}

}  // namespace grelha::GRELHA_ISA
