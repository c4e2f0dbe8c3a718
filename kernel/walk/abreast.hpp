#pragma once
// Rays that have nothing in common but that they are many, each on its own through a grid: their
// steps side by side (SIMD over rays), the primitives of a cell for the one ray that came there
// (SIMD over primitives).
//
// A step is a chain of some 60 cycles: the cell's distance, the planes that far, the next cell from
// these. For one ray it ends in branches nobody can foretell; eight chains at once take little
// longer than one, and branch only for cells that hold something.

#include "kernel/walk/course.hpp"

namespace grelha::GRELHA_ISA {

inline constexpr int kAbreast = kWidth<Lanes>;

/// Asks for the memory of an object, line by line.
template <class T>
[[gnu::always_inline]] inline void prefetch(const T* object) {
  const char* const bytes = reinterpret_cast<const char*>(object);
  for (std::size_t at = 0; at < sizeof(T); at += 64)
    __builtin_prefetch(bytes + at);
}

/// Bytes of the fields of kinds whose primitives are asked for early: of more, they come too late.
inline constexpr std::size_t kAskedFor = 16;

/// Rays that came to cells with something in them, each against its own cell. What a ray needs is
/// asked for before what another needs is computed with: memory is farther away than the next seven
/// rays.
template <bool kAny, class In>
class CellTests {
 public:
  CellTests(Single<In>* rays,
            const CellLists& lists,
            const std::uint32_t (&cells)[kAbreast],
            Counters& n)
      : rays_(rays), lists_(lists), cells_(cells), n_(n) {}

  /// The rays with a bit in `full`. Returns bits of those whose search is over.
  [[gnu::always_inline]] unsigned test(unsigned full) {
    if (triangles_.first)
      test_triangles(full);
    bool any_arrays = false;
    ArrayShapes::for_each([&]<class Shape>() __attribute__((always_inline)) {
      const typename Shape::CellList& list = lists_.of<Shape>();
      any_arrays = any_arrays || list.first;
      if constexpr (sizeof(typename Shape::template Fields<float>) <= kAskedFor)
        if (list.first)
          fetch<Shape>(list, full & ~over_);
    });
    if (any_arrays)
      each_bit(full & ~over_,
               [&](int i) { end_if(test_arrays<kAny>(rays_[i], lists_, cells_[i], n_), i); });
    return over_;
  }

 private:
  static constexpr int kMost = 32;
  /// A block that a ray is still to be tested against.
  struct Due {
    int ray;
    std::uint32_t block;
    float enter;  ///< t of its box; what was met since may be nearer
  };

  [[gnu::always_inline]] void end_if(bool over, int ray) {
    if (over)
      over_ |= 1u << ray;
  }

  [[gnu::always_inline]] void test_triangles(unsigned full) {
    each_bit(full, [&](int i) {
      first_[i] = triangles_.first[cells_[i]];
      end_[i] = triangles_.first[cells_[i] + 1];
      prefetch(triangles_.boxes + first_[i] / kBlock);
    });
    each_bit(full, [&](int i) {
      for (std::uint32_t at = first_[i] / kBlock * kBlock; at < end_[i]; at += kBlock)
        take_blocks(i, at);
    });
    settle();
  }

  /// Takes the blocks from `at` on whose boxes ray i passes.
  [[gnu::always_inline]] void take_blocks(int i, std::uint32_t at) {
    const unsigned passed = passed_boxes(rays_[i], triangles_.boxes[at / kBlock], enters_);
    each_bit(passed & blocks_between(at, first_[i], end_[i]), [&](int k) {
      const std::uint32_t block = at + static_cast<unsigned>(k);
      prefetch(triangles_.blocks + block);
      due_[count_++] = {i, block, enters_[k]};
      if (count_ == kMost)
        settle();
    });
  }

  /// Tests the blocks that are due.
  [[gnu::always_inline]] void settle() {
    for (int k = 0; k < count_; ++k) {
      const int i = due_[k].ray;
      if (!(over_ >> i & 1) && due_[k].enter <= rays_[i].best)
        end_if(test_block<kAny>(rays_[i], triangles_.blocks[due_[k].block], n_), i);
    }
    count_ = 0;
  }

  /// Asks for what the first two blocks of primitives of cells are made of, and for ids: a hit is
  /// likely.
  template <class Shape>
  [[gnu::always_inline]] void fetch(const typename Shape::CellList& list, unsigned rays) {
    each_bit(rays, [&](int i) {
      const std::uint32_t first = list.first[cells_[i]];
      const auto ask = [first](const float* const& field) {
        __builtin_prefetch(field + first);
        __builtin_prefetch(field + first + 16);
      };
      Shape::for_each_field(ask, list.fields);
      __builtin_prefetch(list.id + first);
    });
  }

  Single<In>* rays_;
  const CellLists& lists_;
  const Triangle::CellList& triangles_ = lists_.of<Triangle>();
  const std::uint32_t (&cells_)[kAbreast];
  Counters& n_;
  unsigned over_ = 0;
  int count_ = 0;
  Due due_[kMost];
  std::uint32_t first_[kAbreast];
  std::uint32_t end_[kAbreast];
  float enters_[kBlock];
};

template <bool kAny, class In>
inline unsigned test_cells(Single<In>* rays,
                           const CellLists& lists,
                           const std::uint32_t (&cells)[kAbreast],
                           unsigned full,
                           Counters& n) {
  return CellTests<kAny, In>(rays, lists, cells, n).test(full);
}

/// Courses and cells of many rays.
template <int kRays>
struct Courses {
  alignas(64) float place[3][kRays];
  alignas(64) float speed[3][kRays];
  alignas(64) float inverse[3][kRays];
  alignas(64) float cell[3][kRays];
  alignas(64) float end[kRays];

  void put(int i, const Course<Lanes>& c, const Lanes (&at)[3]) {
    for (int a = 0; a < 3; ++a) {
      store(place[a] + i, c.place[a]);
      store(speed[a] + i, c.speed[a]);
      store(inverse[a] + i, c.inverse[a]);
      store(cell[a] + i, at[a]);
    }
    store(end + i, c.end);
  }
  Course<Lanes> get(int i) const {
    Course<Lanes> c;
    for (int a = 0; a < 3; ++a) {
      c.place[a] = load<Lanes>(place[a] + i);
      c.speed[a] = load<Lanes>(speed[a] + i);
      c.inverse[a] = load<Lanes>(inverse[a] + i);
    }
    c.end = load<Lanes>(end + i);
    return c;
  }
  template <int kOthers>
  void copy(int k, const Courses<kOthers>& from, int i) {
    for (int a = 0; a < 3; ++a) {
      place[a][k] = from.place[a][i];
      speed[a][k] = from.speed[a][i];
      inverse[a][k] = from.inverse[a][i];
      cell[a][k] = from.cell[a][i];
    }
    end[k] = from.end[i];
  }
};

/// Rays of a packet that come to a grid and wait for their turn in it.
struct Waiting {
  Courses<kPacket> course;
  std::uint8_t ray[kPacket];
  int first = 0;
  int end = 0;

  Waiting(const GridView& g, const WalkingRays& p) {
    each_live_group(p, [&](int i, int) { add(g, p, i); });
  }

 private:
  void add(const GridView& g, const WalkingRays& p, int i) {
    Lanes org[3];
    Lanes dir[3];
    for (int a = 0; a < 3; ++a) {
      org[a] = load<Lanes>(p.org[a] + i);
      dir[a] = load<Lanes>(p.dir[a] + i);
    }
    const Lanes begin = greater(load<Lanes>(p.start + i), load<Lanes>(p.t_min + i));
    Course<Lanes> c;
    Lanes cell[3];
    const Mask<Lanes> come = enter(g, org, dir, begin, load<Lanes>(p.best + i), c, cell);
    course.put(i, c, cell);
    each_bit(bits(come), [&](int k) { ray[end++] = static_cast<std::uint8_t>(i + k); });
  }
};

/// The rays that walk side by side. What is not walking goes on computing, within the grid, and is
/// not looked at.
template <class In>
struct Walkers {
  Courses<kAbreast> course = {};
  alignas(64) float best[kAbreast] = {};
  Single<In> ray[kAbreast];
  int of[kAbreast] = {};  ///< place in the packet
  unsigned walking = 0;   ///< bits of those that do

  /// The numbers of their cells.
  [[gnu::always_inline]] Words<Lanes> cells(const GridView& g) const {
    const auto at = [&](int a) { return to_words(load<Lanes>(course.cell[a])); };
    const auto cells_along = [&](int a) { return static_cast<std::uint32_t>(g.n[a]); };
    return at(0) + cells_along(0) * (at(1) + cells_along(1) * at(2));
  }

  /// Tests rays against what is in their cells. Returns bits of those whose search is over.
  template <bool kAny>
  [[gnu::always_inline]] unsigned test(const CellLists& lists,
                                       const Words<Lanes>& cell,
                                       unsigned rays,
                                       Counters& n) {
    std::uint32_t in[kAbreast];
    store_words(in, cell);
    const unsigned over = test_cells<kAny>(ray, lists, in, rays, n);
    each_bit(rays, [&](int k) { best[k] = ray[k].best; });
    return over;
  }

  /// Goes on to the next cells. Returns bits of those that come there.
  [[gnu::always_inline]] unsigned go_on(const GridView& g, const Lanes& distance) {
    Lanes at[3];
    for (int a = 0; a < 3; ++a)
      at[a] = load<Lanes>(course.cell[a]);
    const Mask<Lanes> going = step(g, course.get(0), distance, load<Lanes>(best), at);
    for (int a = 0; a < 3; ++a)
      store(course.cell[a], select(going, at[a], Lanes(0)));
    return bits(going);
  }

  /// Waiting rays take the places of those that are done.
  void refill(Waiting& w, const Packet<In>& p, bool any_triangles) {
    for (unsigned idle = ~walking & ((1u << kAbreast) - 1u); idle != 0 && w.first < w.end;
         idle &= idle - 1) {
      const int k = __builtin_ctz(idle);
      const int i = w.ray[w.first++];
      course.copy(k, w.course, i);
      ray[k] = single_of(p, i, any_triangles);
      best[k] = ray[k].best;
      of[k] = i;
      walking |= 1u << k;
    }
  }
  void retire(unsigned done, Packet<In>& p) {
    walking &= ~done;
    each_bit(done, [&](int k) { put_back(ray[k], p, of[k]); });
  }
};

/// Each walker looks into its cell and goes on to the next. Returns bits of those whose search is
/// over.
template <bool kAny, class In>
[[gnu::always_inline]] inline unsigned look_and_step(const GridView& g,
                                                     Walkers<In>& w,
                                                     Counters& n) {
  const Words<Lanes> cell = w.cells(g);
  const Lanes distance = bytes_at(g.distance, cell);
  unsigned over = 0;
  if (const unsigned full = bits(distance == Lanes(0)) & w.walking; full != 0)
    over = w.template test<kAny>(g.lists, cell, full, n);
  return over | ~w.go_on(g, distance);
}

/// The live rays of a packet through a grid, each from p.start on and on its own (Amanatides & Woo
/// 1987), with leaps over empty cells by their distance (Cohen & Sheffer, "Proximity Clouds",
/// 1994). A hit is never clipped to its cell; a walk ends once the hit lies at or before the exit
/// of the cell. Plane distances come from the plane's index, never by adding up; where float takes
/// a ray to the wrong side of a corner it is off by less than what primitives were grown by
/// (docs/numerics.md).
template <bool kAny, class In>
inline void walk_apart(const GridView& g, Packet<In>& p, bool any_triangles, Counters& n) {
  Waiting waiting(g, p);
  if (waiting.end == 0)
    return;
  Walkers<In> w;
  // No walk crosses more planes than there are, whatever rounding does.
  const std::int64_t most = std::int64_t{waiting.end} * (g.n[0] + g.n[1] + g.n[2] + 3);
  for (std::int64_t step = 0; step < most; ++step) {
    if (waiting.first < waiting.end && 2 * __builtin_popcount(w.walking) <= kAbreast)
      w.refill(waiting, p, any_triangles);
    if (w.walking == 0)
      return;
    n.visits += static_cast<unsigned>(__builtin_popcount(w.walking));
    w.retire(look_and_step<kAny>(g, w, n) & w.walking, p);
  }
  w.retire(w.walking, p);
}

}  // namespace grelha::GRELHA_ISA
