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
template <bool kAny, class In>
inline unsigned test_cells(Single<In>* r,
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
template <class Real>
inline Real clamp_cells(const Real& x, int n) {
  return whole(lesser(greater(x, Real(0)), Real(static_cast<float>(n - 1))));
}

/// Rays in the units of one grid's cells.
template <class Real>
struct Course {
  Real place[3];    ///< at t = 0
  Real speed[3];    ///< what they make in one t
  Real inverse[3];  ///< of the speed
  Real end;         ///< t where they leave the grid or their search
};

/// The cells that rays from t = begin to t = best start in. Returns those that come to the grid.
template <class Real>
[[gnu::always_inline]] inline Mask<Real> enter(const GridView& g,
                                               const Real (&org)[3],
                                               const Real (&dir)[3],
                                               const Real& begin,
                                               const Real& best,
                                               Course<Real>& c,
                                               Real (&cell)[3]) {
  Real t0 = begin, t1 = best;
  const Mask<Real> search = best > begin;
  const Real least = least_headway(dir[0], dir[1], dir[2]);
  for (int a = 0; a < 3; ++a) {
    const Real size(static_cast<float>(g.n[a]));
    c.place[a] = (org[a] - Real(g.lo_f[a])) * Real(g.inv_cell_f[a]);
    const Real tiny = select(dir[a] < Real(0), Real(0) - least, least);
    c.speed[a] = select(magnitude(dir[a]) < least, tiny, dir[a]) * Real(g.inv_cell_f[a]);
    c.inverse[a] = Real(1) / c.speed[a];
    const Real x = (Real(0) - c.place[a]) * c.inverse[a], y = (size - c.place[a]) * c.inverse[a];
    t0 = greater(lesser(x, y), t0);
    t1 = lesser(greater(x, y), t1);
  }
  for (int a = 0; a < 3; ++a)
    cell[a] = clamp_cells(c.place[a] + t0 * c.speed[a], g.n[a]);
  c.end = t1;
  return both(search, t0 <= t1);
}

/// The next cells of rays whose cells are `distance` from the nearest that holds something. Returns
/// those that come there before they have met anything.
template <class Real>
[[gnu::always_inline]] inline Mask<Real> step(const GridView& g,
                                              const Course<Real>& c,
                                              const Real& distance,
                                              const Real& best,
                                              Real (&cell)[3]) {
  // cells this far on each side are empty too
  const Real leap = greater(distance - Real(1), Real(0));
  Real t[3], next[3];
  for (int a = 0; a < 3; ++a) {
    const Mask<Real> up = c.inverse[a] > Real(0);
    next[a] = select(up, cell[a] + leap + Real(1), cell[a] - leap - Real(1));
    const Real plane = select(up, next[a], next[a] + Real(1));
    t[a] = (plane - c.place[a]) * c.inverse[a];
  }
  const Mask<Real> y = t[1] < t[0];
  Real exit = select(y, t[1], t[0]);
  const Mask<Real> z = t[2] < exit;
  exit = select(z, t[2], exit);
  const Mask<Real> axis[3] = {but_not(exit == exit, either(y, z)), but_not(y, z), z};
  Mask<Real> going = both(best > exit, exit <= c.end);
  for (int a = 0; a < 3; ++a) {
    const Real side =
        lesser(greater(clamp_cells(c.place[a] + exit * c.speed[a], g.n[a]), cell[a] - leap),
               cell[a] + leap);
    const Real to = select(axis[a], next[a], side);
    going = both(going, both(to >= Real(0), to < Real(static_cast<float>(g.n[a]))));
    cell[a] = to;
  }
  return going;
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
  int first = 0, end = 0;

  Waiting(const GridView& g, const WalkingRays& p) {
    each_live_group(p, [&](int i, int) {
      const Lanes org[3] = {
          load<Lanes>(p.org[0] + i), load<Lanes>(p.org[1] + i), load<Lanes>(p.org[2] + i)};
      const Lanes dir[3] = {
          load<Lanes>(p.dir[0] + i), load<Lanes>(p.dir[1] + i), load<Lanes>(p.dir[2] + i)};
      const Lanes begin = greater(load<Lanes>(p.start + i), load<Lanes>(p.t_min + i));
      Course<Lanes> c;
      Lanes cell[3];
      const Mask<Lanes> come = enter(g, org, dir, begin, load<Lanes>(p.best + i), c, cell);
      course.put(i, c, cell);
      for (unsigned rays = bits(come); rays != 0; rays &= rays - 1)
        ray[end++] = static_cast<std::uint8_t>(i + __builtin_ctz(rays));
    });
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

  /// Waiting rays take the places of those that are done.
  void refill(Waiting& w, const Packet<In>& p, bool any_triangles) {
    for (unsigned idle = ~walking & ((1u << kAbreast) - 1u); idle != 0 && w.first < w.end;
         idle &= idle - 1) {
      const int k = __builtin_ctz(idle), i = w.ray[w.first++];
      course.copy(k, w.course, i);
      ray[k] = single_of(p, i, any_triangles);
      best[k] = ray[k].best;
      of[k] = i;
      walking |= 1u << k;
    }
  }
  void retire(unsigned done, Packet<In>& p) {
    walking &= ~done;
    for (; done != 0; done &= done - 1) {
      const int k = __builtin_ctz(done);
      put_back(ray[k], p, of[k]);
    }
  }
};

/// Each walker looks into its cell and goes on to the next. Returns bits of those whose search is
/// over.
template <bool kAny, class In>
[[gnu::always_inline]] inline unsigned look_and_step(const GridView& g,
                                                     Walkers<In>& w,
                                                     Counters& n) {
  const std::uint32_t nx = static_cast<std::uint32_t>(g.n[0]),
                      ny = static_cast<std::uint32_t>(g.n[1]);
  Lanes at[3];
  for (int a = 0; a < 3; ++a)
    at[a] = load<Lanes>(w.course.cell[a]);
  const Words<Lanes> cell = to_words(at[0]) + nx * (to_words(at[1]) + ny * to_words(at[2]));
  const Lanes distance = bytes_at(g.distance, cell);
  unsigned over = 0;
  if (unsigned full = bits(distance == Lanes(0)) & w.walking; full != 0) {
    std::uint32_t cells[kAbreast];
    store_words(cells, cell);
    over = test_cells<kAny>(w.ray, g.lists, cells, full, n);
    for (; full != 0; full &= full - 1) {
      const int k = __builtin_ctz(full);
      w.best[k] = w.ray[k].best;
    }
  }
  const Mask<Lanes> going = step(g, w.course.get(0), distance, load<Lanes>(w.best), at);
  for (int a = 0; a < 3; ++a)
    store(w.course.cell[a], select(going, at[a], Lanes(0)));
  return over | ~bits(going);
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
