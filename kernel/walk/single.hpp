#pragma once
// One ray at a time against blocks of primitives (SIMD over primitives): the way a packet goes on
// when its rays have nothing left in common. abreast.hpp takes such rays through grids.

#include "kernel/walk/packet.hpp"

namespace grelha::GRELHA_ISA {

/// A ray as it walks grids.
struct WalkingRay {
  float org[3], dir[3], t_min, best;
  std::uint32_t id;
  int axis;      ///< of the shear
  float inv[3];  ///< inverse of the direction; this and what follows with triangles only
  /// the side of a box that the ray meets first, along each axis; the other is 3 places on or back
  int near[3];
};

/// As TestedRays.
template <class In>
struct TestedRay {};
template <>
struct TestedRay<InDouble> {
  double from[3];
  float after;
  double nearest;
  double shift;  ///< 0 for rays not moved
};

/// A ray that is tested against primitives in float or in double.
template <class In>
struct Single : WalkingRay, TestedRay<In> {
  typename In::Number inv_dd;
  typename In::Number shear[3];
};

/// What tests take of a ray.
inline const float (&tested_org(const Single<InFloat>& r))[3] {
  return r.org;
}
inline float tested_t_min(const Single<InFloat>& r) {
  return r.t_min;
}
inline float tested_best(const Single<InFloat>& r) {
  return r.best;
}
inline void set_best(Single<InFloat>& r, float t) {
  r.best = t;
}

inline const double (&tested_org(const Single<InDouble>& r))[3] {
  return r.from;
}
inline float tested_t_min(const Single<InDouble>& r) {
  return r.after;
}
inline double tested_best(const Single<InDouble>& r) {
  return r.nearest;
}
inline void set_best(Single<InDouble>& r, double t) {
  r.nearest = t;
  r.best = not_below(t - r.shift);
}

/// What tests of triangles need of a direction besides the shear.
inline void set_inverse(WalkingRay& r) {
  const float least = least_headway(r.dir[0], r.dir[1], r.dir[2]);
  for (int a = 0; a < 3; ++a) {
    r.inv[a] = 1 / (magnitude(r.dir[a]) < least ? least : r.dir[a]);
    r.near[a] = r.inv[a] < 0 ? 3 + a : a;
  }
}

inline void set_tested(Single<InFloat>&) {}
inline void set_tested(Single<InDouble>& r) {
  for (int a = 0; a < 3; ++a)
    r.from[a] = r.org[a];
  r.after = r.t_min;
  r.nearest = r.best;
  r.shift = 0;
}

/// A ray by itself, as prepare(Packet&) makes many. False: it meets nothing, and r is not whole.
template <class In>
inline bool prepare(Single<In>& r,
                    const Vec3<float>& org,
                    const Vec3<float>& d,
                    float t_min,
                    float t_max,
                    bool any_triangles) {
  using Number = typename In::Number;
  if (!(t_max > t_min))
    return false;
  const float dd = dot(d, d);
  // NaN and infinity times zero are NaN
  const float sum = ((org.x + org.y) + (org.z + dd)) + 1 / dd;
  if (!(sum * 0 == 0))
    return false;
  r.org[0] = org.x;
  r.org[1] = org.y;
  r.org[2] = org.z;
  r.dir[0] = d.x;
  r.dir[1] = d.y;
  r.dir[2] = d.z;
  r.t_min = t_min;
  r.best = t_max;
  r.id = kNoPrimitive;
  const Vec3<Number> e{d.x, d.y, d.z};
  r.inv_dd = 1 / dot(e, e);
  r.axis = 0;
  if (any_triangles) {
    r.axis = shear_axis(d.x, d.y, d.z);
    const Vec3<Number> q = permuted<Number>(static_cast<Number>(r.axis), e);
    r.shear[0] = q.x / q.z;
    r.shear[1] = q.y / q.z;
    r.shear[2] = 1 / q.z;
    set_inverse(r);
  }
  set_tested(r);
  return true;
}

/// Takes from a packet what only tests in double look at.
inline void take_tested(Single<InFloat>&, const Packet<InFloat>&, int) {}
inline void take_tested(Single<InDouble>& r, const Packet<InDouble>& p, int i) {
  for (int a = 0; a < 3; ++a)
    r.from[a] = p.from[a][i];
  r.after = p.after[i];
  r.nearest = p.nearest[i];
  r.shift = p.moved ? p.shift[i] : 0;
}
/// Gives it back.
inline void put_tested(const Single<InFloat>&, Packet<InFloat>&, int) {}
inline void put_tested(const Single<InDouble>& r, Packet<InDouble>& p, int i) {
  p.nearest[i] = r.nearest;
}

template <class In>
inline Single<In> single_of(const Packet<In>& p, int i, bool any_triangles) {
  Single<In> r;
  for (int a = 0; a < 3; ++a) {
    r.org[a] = p.org[a][i];
    r.dir[a] = p.dir[a][i];
  }
  r.inv_dd = p.inv_dd[i];
  r.t_min = p.t_min[i];
  r.best = p.best[i];
  r.id = id_of(p.id[i]);
  take_tested(r, p, i);
  r.axis = 0;
  if (any_triangles) {
    r.axis = static_cast<int>(p.axis[i]);
    for (int a = 0; a < 3; ++a)
      r.shear[a] = p.shear[a][i];
    set_inverse(r);
  }
  return r;
}

/// What a ray has met goes back to its packet.
template <class In>
inline void put_back(const Single<In>& r, Packet<In>& p, int i) {
  p.best[i] = r.best;
  p.id[i] = bits_of(r.id);
  put_tested(r, p, i);
}

/// Takes the hits of a block in order of place. Returns whether the search is over (kAny and
/// something was hit).
template <bool kAny, class In>
inline bool note(Single<In>& r,
                 const Mask<typename In::Primitives>& hit,
                 const typename In::Primitives& t,
                 const std::uint32_t* ids) {
  using Real = typename In::Primitives;
  using Number = typename In::Number;
  unsigned lanes = bits(both(hit, t <= Real(tested_best(r))));
  if (lanes == 0)
    return false;
  Number at[kWidth<Real>];
  store(at, t);
  for (; lanes != 0; lanes &= lanes - 1) {
    const int k = __builtin_ctz(lanes);
    const bool closer = at[k] < tested_best(r);
    const bool tie = at[k] == tested_best(r) && r.id != kNoPrimitive && ids[k] < r.id;
    if (kAny && closer) {
      set_best(r, -kInfinity);
      r.id = ids[k];
      return true;
    }
    if (!kAny && (closer || tie)) {
      set_best(r, at[k]);
      r.id = ids[k];
    }
  }
  return false;
}

/// Takes one hit; as note().
template <bool kAny, class In>
inline bool record_hit(Single<In>& r, bool hit, typename In::Number t, std::uint32_t id) {
  if (!hit)
    return false;
  const typename In::Number best = tested_best(r);
  if (kAny) {
    if (!(t < best))
      return false;
    set_best(r, -kInfinity);
    r.id = id;
    return true;
  }
  if (t < best || (t == best && r.id != kNoPrimitive && id < r.id)) {
    set_best(r, t);
    r.id = id;
  }
  return false;
}

/// Bits of the boxes that a ray passes through before its search ends, and where it enters them.
inline unsigned passed_boxes(const WalkingRay& r,
                             const BlockBoxes& boxes,
                             float (&enters)[kBlock]) {
  unsigned passed = 0;
  for (int i = 0; i < kBlock; i += kWidth<Block>) {
    Block enter(r.t_min), leave(r.best);
    for (int a = 0; a < 3; ++a) {
      const Block org(r.org[a]), inv(r.inv[a]);
      enter = greater((load<Block>(boxes.side[r.near[a]] + i) - org) * inv, enter);
      leave = lesser((load<Block>(boxes.side[2 * a + 3 - r.near[a]] + i) - org) * inv, leave);
    }
    passed |= bits(enter <= leave) << i;
    store(enters + i, enter);
  }
  return passed;
}

/// Bits of those eight blocks from `at` on (a multiple of eight) that lie in [first, end).
inline unsigned blocks_between(std::uint32_t at, std::uint32_t first, std::uint32_t end) {
  constexpr unsigned kAll = (1u << kBlock) - 1;
  const unsigned from = first > at ? kAll << (first - at) : kAll;
  return end - at < kBlock ? from & ~(kAll << (end - at)) & kAll : from & kAll;
}

template <class Real, class Number>
inline Vec3<Real> spread(const Number (&v)[3]) {
  return {Real(v[0]), Real(v[1]), Real(v[2])};
}

/// A ray and triangles of a block from i on.
template <class In>
struct RayAndBlock {
  using Real = typename In::Primitives;
  const Single<In>* r;
  const TriangleBlock* block;
  int i;
  RayAndTriangle<Real> operator()() const {
    const int k = r->axis;
    const int kx = kNextAxis[k];
    const int ky = kPreviousAxis[k];
    const auto& from = tested_org(*r);
    const auto corner = [&](const float(&v)[3][kBlock]) {
      return Vec3<Real>{take<Real>(v[kx] + i), take<Real>(v[ky] + i), take<Real>(v[k] + i)};
    };
    return {{Real(from[kx]), Real(from[ky]), Real(from[k])},
            {Real(r->dir[kx]), Real(r->dir[ky]), Real(r->dir[k])},
            {corner(block->a), corner(block->b), corner(block->c)}};
  }
};

template <bool kAny, class In>
[[gnu::noinline]] bool test_block(Single<In>& r, const TriangleBlock& block, Counters& n) {
  using Real = typename In::Primitives;
  const Shear<Real> shear{Real(r.shear[0]), Real(r.shear[1]), Real(r.shear[2])};
  const Real t_min(tested_t_min(r));
  n.tests[kNumber<Triangle>] += kBlock;
  for (int i = 0; i < kBlock; i += kWidth<Real>) {
    Real t(0);
    const Mask<Real> hit =
        hit_triangle<kAny>(RayAndBlock<In>{&r, &block, i}, shear, t_min, Real(tested_best(r)), t);
    if (note<kAny>(r, hit, t, block.id + i))
      return true;
  }
  return false;
}

/// Primitives of one kind in one cell. Reading past its end meets those of the next, which costs
/// nothing and is never wrong: a hit is a hit.
template <bool kAny, class Shape, class In>
[[gnu::always_inline]] inline bool test_list(Single<In>& r,
                                             const typename Shape::CellList& list,
                                             std::size_t cell,
                                             Counters& n) {
  using Real = typename In::Primitives;
  const RayLanes<Real> ray{.org = spread<Real>(tested_org(r)),
                           .dir = spread<Real>(r.dir),
                           .inv_dd = Real(r.inv_dd),
                           .t_min = Real(tested_t_min(r))};
  const std::uint32_t end = list.first[cell + 1];
  for (std::uint32_t i = list.first[cell]; i < end; i += kWidth<Real>) {
    n.tests[kNumber<Shape>] += kWidth<Real>;
    Real t(0);
    const Mask<Real> hit = meet(ray, side_by_side<Shape, Real>(list.fields, i), t);
    if (note<kAny>(r, hit, t, list.id + i))
      return true;
  }
  return false;
}

/// What stands in arrays in one cell.
template <bool kAny, class In>
inline bool test_arrays(Single<In>& r, const CellLists& lists, std::size_t cell, Counters& n) {
  bool over = false;
  ArrayShapes::for_each([&]<class Shape>() __attribute__((always_inline)) {
    const typename Shape::CellList& list = lists.of<Shape>();
    over = over || (list.first && test_list<kAny, Shape>(r, list, cell, n));
  });
  return over;
}

/// All primitives of one cell.
template <bool kAny, class In>
inline bool test_cell(Single<In>& r, const CellLists& lists, std::size_t cell, Counters& n) {
  const Triangle::CellList& triangles = lists.of<Triangle>();
  if (triangles.first)
    for (std::uint32_t i = triangles.first[cell]; i < triangles.first[cell + 1]; ++i)
      if (test_block<kAny>(r, triangles.blocks[i], n))
        return true;
  return test_arrays<kAny>(r, lists, cell, n);
}

/// A ray in the units of one grid's cells, in double: plane distances come from the plane's index,
/// never by adding up, and the cell of a point is the one the builder gives it (cell_of in
/// grid.hpp).
struct GridRay {
  double p[3], q[3], iq[3];
};

inline double tame(double d, double least) {
  if (d < 0)
    return d > -least ? -least : d;
  return d < least ? least : d;
}

inline GridRay to_grid(const GridView& g, const float (&org)[3], const float (&dir)[3]) {
  GridRay r;
  const double least = least_headway(dir[0], dir[1], dir[2]);
  for (int a = 0; a < 3; ++a) {
    r.p[a] = (static_cast<double>(org[a]) - g.lo[a]) * g.inv_cell[a];
    r.q[a] = tame(static_cast<double>(dir[a]), least) * g.inv_cell[a];
    r.iq[a] = 1 / r.q[a];
  }
  return r;
}

/// Part of [t0, t1] inside the box of all cells; empty when t0 > t1 (or anything is NaN: !(t0 <=
/// t1)).
inline void clip_to_grid(const GridView& g, const GridRay& r, double& t0, double& t1) {
  for (int a = 0; a < 3; ++a) {
    const double near = (r.q[a] > 0 ? -r.p[a] : g.n[a] - r.p[a]) * r.iq[a];
    const double far = (r.q[a] > 0 ? g.n[a] - r.p[a] : -r.p[a]) * r.iq[a];
    if (near > t0)
      t0 = near;
    if (!(far >= t1))
      t1 = far;
  }
}

inline int clamp_cell(double x, int n) {
  if (!(x > 0))
    return 0;
  const int i = static_cast<int>(x < n ? x : n);
  return i < n ? i : n - 1;
}

}  // namespace grelha::GRELHA_ISA
