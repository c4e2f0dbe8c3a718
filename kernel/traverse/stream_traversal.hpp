#pragma once
// Takes many rays that have nothing else in common through a grid, each on its own. All rays under
// way step side by side (SIMD over rays); then the rays that came to cells with something in them
// are tested there, each by itself (SIMD over primitives).
//
// What a ray does next cannot be predicted, nor what is in the cell it came to: so except for hits
// hardly a branch depends on one ray. Each phase goes through a list of the rays, boxes or blocks
// that the phase before it chose, and prefetches what the phase after it reads.

#include "kernel/traverse/active_rays.hpp"
#include "kernel/traverse/pair_tests.hpp"

namespace grelha::GRELHA_ISA {

/// Prefetches an object, line by line.
template <class T>
[[gnu::always_inline]] inline void prefetch(const T* object) {
  const char* const bytes = reinterpret_cast<const char*>(object);
  for (std::size_t at = 0; at < sizeof(T); at += 64)
    __builtin_prefetch(bytes + at);
}

/// Most bytes of the fields of kinds whose primitives are prefetched: larger ones come too late.
inline constexpr std::size_t kAskedFor = 16;

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
      store_words(due_ray_ + due, Words<Block>{} + ray);
      selected.store(due_block_ + due, counted_words<Block>(block + static_cast<unsigned>(i)));
      due += selected.count();
    }
    return due;
  }

  /// Tests the blocks that are due.
  [[gnu::noinline]] void flush(int due) {
    count_rows<Triangle>(n_, due, kBlock);
    for (int k = 0; k < due && k < kPrefetch; ++k)
      prefetch(triangles_.blocks + due_block_[k]);
    for (int k = 0; k < due; ++k) {
      const int next = k + kPrefetch < due ? k + kPrefetch : due - 1;
      prefetch(triangles_.blocks + due_block_[next]);
      pairs_.add(due_ray_[k], due_block_[k]);
    }
    pairs_.test();
  }

  template <class Shape>
  [[gnu::noinline]] void test_arrays(const LeafQueue& to) {
    const typename Shape::CellList& list = lists_.of<Shape>();
    if constexpr (sizeof(typename Shape::template Fields<float>) <= kAskedFor)
      for (int k = 0; k < to.count; ++k)
        fetch<Shape>(list, list.first[to.cell[k]]);
    if constexpr (kFind == Find::kAll)
      for (int k = 0; k < to.count; ++k)
        list_rows<Shape>(PacketRay{p_, static_cast<int>(to.ray[k])}, list, to.cell[k]);
    else if constexpr (!kAny && kSortsOut<Shape>)
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
  static constexpr bool kSortsOut = requires(const SimdRays<Block>& ray,
                                             const typename Shape::template Fields<Block>& row) {
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
        due_ray_[due] = to.ray[k];
        due_block_[due] = i;
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
      PacketRay r{p_, static_cast<int>(due_ray_[k])};
      if (searches(r.i))
        test_row<kAny, Shape>(r, spread<Block>(r), list, due_block_[k]);
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
  alignas(64) std::uint32_t due_ray_[kMost + kBlock];
  alignas(64) std::uint32_t due_block_[kMost + kBlock];
  PairTests<kFind> pairs_;
};

/// The live rays of a packet through a grid, each from p.start on and on its own (Amanatides & Woo
/// 1987), with leaps over empty cells by their distance (Cohen & Sheffer, "Proximity Clouds",
/// 1994). A hit is never clipped to its cell; a walk ends once the hit lies at or before the exit
/// of the cell. Plane distances come from the plane's index, never by adding up; if float takes a
/// ray to the wrong side of a corner, the error is less than the pad around primitives
/// (docs/numerics.md).
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
