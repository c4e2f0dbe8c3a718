#pragma once
// Rays that have nothing in common but that they are many, each on its own through a grid: their
// steps side by side (SIMD over rays), the primitives of a cell for the one ray that came there
// (SIMD over primitives).
//
// A step is a chain of some 60 cycles: the cell's distance, the planes that far, the next cell from
// these. For one ray it ends in branches nobody can foretell; eight chains at once take little
// longer than one, and branch only for cells that hold something.

#include "kernel/trace/single.hpp"

namespace grelha::GRELHA_ISA {

inline constexpr int kAbreast = kWidth<Lanes>;

/// Each ray with a bit in `full` against its cell. Returns bits of those whose search is over. What
/// a ray needs is asked for before what another needs is computed with: memory is farther away than
/// the next seven rays.
template <bool kAny>
inline unsigned test_cells(Single* r,
                           const CellLists& lists,
                           const std::uint32_t (&cells)[kAbreast],
                           unsigned full,
                           Counters& n) {
  unsigned over = 0;
  if (lists.triangle_first) {
    constexpr int kMost = 32;
    struct Due {
      int ray;
      std::uint32_t block;
      float enter;  ///< t of its box; what was met since may be nearer
    } due[kMost];
    int count = 0;
    const auto settle = [&] {
      for (int k = 0; k < count; ++k) {
        const int i = due[k].ray;
        if (!(over >> i & 1) && due[k].enter <= r[i].best &&
            test_block<kAny>(r[i], lists.triangles[due[k].block], n))
          over |= 1u << i;
      }
      count = 0;
    };
    std::uint32_t first[kAbreast], end[kAbreast];
    for (unsigned left = full; left != 0; left &= left - 1) {
      const int i = __builtin_ctz(left);
      first[i] = lists.triangle_first[cells[i]];
      end[i] = lists.triangle_first[cells[i] + 1];
      const char* const boxes = reinterpret_cast<const char*>(lists.boxes + first[i] / kBlock);
      for (std::size_t at = 0; at < sizeof(BlockBoxes); at += 64)
        __builtin_prefetch(boxes + at);
    }
    float enters[kBlock];
    for (unsigned left = full; left != 0; left &= left - 1) {
      const int i = __builtin_ctz(left);
      for (std::uint32_t at = first[i] / kBlock * kBlock; at < end[i]; at += kBlock)
        for (unsigned passed = passed_boxes(r[i], lists.boxes[at / kBlock], enters) &
                               blocks_between(at, first[i], end[i]);
             passed != 0;
             passed &= passed - 1) {
          const std::uint32_t b = at + static_cast<unsigned>(__builtin_ctz(passed));
          const char* const lines = reinterpret_cast<const char*>(lists.triangles + b);
          for (std::size_t line = 0; line < sizeof(TriangleBlock); line += 64)
            __builtin_prefetch(lines + line);
          due[count++] = {i, b, enters[b - at]};
          if (count == kMost)
            settle();
        }
    }
    settle();
  }
  if (lists.sphere_first)
    for (unsigned left = full & ~over; left != 0; left &= left - 1) {
      const std::uint32_t first = lists.sphere_first[cells[__builtin_ctz(left)]];
      for (const float* const from : {lists.sx, lists.sy, lists.sz, lists.sr})
        __builtin_prefetch(from + first), __builtin_prefetch(from + first + 16);
    }
  if (lists.sphere_first || lists.cone_first)
    for (unsigned left = full & ~over; left != 0; left &= left - 1) {
      const int i = __builtin_ctz(left);
      if (test_round<kAny>(r[i], lists, cells[i], n))
        over |= 1u << i;
    }
  return over;
}

/// clamp_cell, lane by lane: 0 for NaN.
inline Lanes clamp_cells(const Lanes& x, int n) {
  return whole(lesser(greater(x, Lanes(0)), Lanes(static_cast<float>(n - 1))));
}

/// A ray in the units of one grid's cells: where it is at t = 0, what it makes in one t, the
/// inverse of that, the cell it starts in and the t where it leaves the grid or its search.
struct Course {
  enum Field { kPlace, kSpeed = 3, kInverse = 6, kCell = 9, kEnd = 12, kFields = 13 };
};

/// The live rays of a packet through a grid, each from p.start on and on its own (Amanatides & Woo
/// 1987), with leaps over empty cells by their distance (Cohen & Sheffer, "Proximity Clouds",
/// 1994). A hit is never clipped to its cell; a walk ends once the hit lies at or before the exit
/// of the cell. Plane distances come from the plane's index, never by adding up; where float takes
/// a ray to the wrong side of a corner it is off by less than what primitives were grown by
/// (docs/numerics.md).
template <bool kAny>
inline void walk_apart(const GridView& g, Packet& p, bool any_triangles, Counters& n) {
  alignas(64) float course[Course::kFields][kPacket];
  std::uint8_t waiting[kPacket];
  int first = 0, end = 0;
  each_live_group(p, [&](int i, int) {
    const Lanes begin = greater(load<Lanes>(p.start + i), load<Lanes>(p.t_min + i));
    Lanes t0 = begin, t1 = load<Lanes>(p.best + i), place[3], speed[3];
    const Mask<Lanes> search = t1 > begin;
    const Lanes least = least_headway(p, i);
    for (int a = 0; a < 3; ++a) {
      const Lanes d = load<Lanes>(p.dir[a] + i), size(static_cast<float>(g.n[a]));
      place[a] = (load<Lanes>(p.org[a] + i) - Lanes(g.lo_f[a])) * Lanes(g.inv_cell_f[a]);
      const Lanes tiny = select(d < Lanes(0), Lanes(0) - least, least);
      speed[a] = select(magnitude(d) < least, tiny, d) * Lanes(g.inv_cell_f[a]);
      const Lanes inverse = Lanes(1) / speed[a];
      const Lanes x = (Lanes(0) - place[a]) * inverse, y = (size - place[a]) * inverse;
      t0 = greater(lesser(x, y), t0);
      t1 = lesser(greater(x, y), t1);
      store(course[Course::kPlace + a] + i, place[a]);
      store(course[Course::kSpeed + a] + i, speed[a]);
      store(course[Course::kInverse + a] + i, inverse);
    }
    for (int a = 0; a < 3; ++a)
      store(course[Course::kCell + a] + i, clamp_cells(place[a] + t0 * speed[a], g.n[a]));
    store(course[Course::kEnd] + i, t1);
    for (unsigned rays = bits(both(search, t0 <= t1)); rays != 0; rays &= rays - 1)
      waiting[end++] = static_cast<std::uint8_t>(i + __builtin_ctz(rays));
  });
  if (end == 0)
    return;

  // What is not walking goes on computing, within the grid, and is not looked at.
  alignas(64) float now[Course::kFields][kAbreast] = {}, best[kAbreast] = {};
  Single r[kAbreast];
  int of[kAbreast] = {};
  unsigned walking = 0;
  const auto retire = [&](unsigned done) {
    for (; done != 0; done &= done - 1) {
      const int k = __builtin_ctz(done);
      put_back(r[k], p, of[k]);
    }
  };
  // No walk crosses more planes than there are, whatever rounding does.
  const std::int64_t most = std::int64_t{end} * (g.n[0] + g.n[1] + g.n[2] + 3);
  const std::uint32_t nx = static_cast<std::uint32_t>(g.n[0]),
                      ny = static_cast<std::uint32_t>(g.n[1]);
  for (std::int64_t step = 0; step < most; ++step) {
    if (first < end && 2 * __builtin_popcount(walking) <= kAbreast)
      for (unsigned idle = ~walking & ((1u << kAbreast) - 1u); idle != 0 && first < end;
           idle &= idle - 1) {
        const int k = __builtin_ctz(idle), i = waiting[first++];
        for (int f = 0; f < Course::kFields; ++f)
          now[f][k] = course[f][i];
        r[k] = single_of(p, i, any_triangles);
        best[k] = r[k].best;
        of[k] = i;
        walking |= 1u << k;
      }
    if (walking == 0)
      return;
    n.visits += static_cast<unsigned>(__builtin_popcount(walking));

    Lanes at[3];
    for (int a = 0; a < 3; ++a)
      at[a] = load<Lanes>(now[Course::kCell + a]);
    const Words<Lanes> cell = to_words(at[0]) + nx * (to_words(at[1]) + ny * to_words(at[2]));
    const Lanes distance = bytes_at(g.distance, cell);
    unsigned over = 0;
    if (unsigned full = bits(distance == Lanes(0)) & walking; full != 0) {
      std::uint32_t cells[kAbreast];
      store_words(cells, cell);
      over = test_cells<kAny>(r, g.lists, cells, full, n);
      for (; full != 0; full &= full - 1) {
        const int k = __builtin_ctz(full);
        best[k] = r[k].best;
      }
    }

    // cells this far on each side are empty too
    const Lanes leap = greater(distance - Lanes(1), Lanes(0));
    Lanes t[3], next[3];
    for (int a = 0; a < 3; ++a) {
      const Lanes inverse = load<Lanes>(now[Course::kInverse + a]);
      const Mask<Lanes> up = inverse > Lanes(0);
      next[a] = select(up, at[a] + leap + Lanes(1), at[a] - leap - Lanes(1));
      const Lanes plane = select(up, next[a], next[a] + Lanes(1));
      t[a] = (plane - load<Lanes>(now[Course::kPlace + a])) * inverse;
    }
    const Mask<Lanes> y = t[1] < t[0];
    Lanes exit = select(y, t[1], t[0]);
    const Mask<Lanes> z = t[2] < exit;
    exit = select(z, t[2], exit);
    const Mask<Lanes> axis[3] = {but_not(exit == exit, either(y, z)), but_not(y, z), z};
    Mask<Lanes> going = both(load<Lanes>(best) > exit, exit <= load<Lanes>(now[Course::kEnd]));
    for (int a = 0; a < 3; ++a) {
      const Lanes place = load<Lanes>(now[Course::kPlace + a]),
                  speed = load<Lanes>(now[Course::kSpeed + a]);
      const Lanes side =
          lesser(greater(clamp_cells(place + exit * speed, g.n[a]), at[a] - leap), at[a] + leap);
      const Lanes to = select(axis[a], next[a], side);
      going = both(going, both(to >= Lanes(0), to < Lanes(static_cast<float>(g.n[a]))));
      at[a] = to;
    }
    over |= ~bits(going);
    for (int a = 0; a < 3; ++a)
      store(now[Course::kCell + a], select(going, at[a], Lanes(0)));
    retire(over & walking);
    walking &= ~over;
  }
  retire(walking);
}

}  // namespace grelha::GRELHA_ISA
