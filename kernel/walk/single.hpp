#pragma once
// One ray at a time against blocks of primitives (SIMD over primitives): the way a packet goes on
// when its rays have nothing left in common. abreast.hpp takes such rays through grids.

#include "kernel/simd/lanes_four.hpp"
#include "kernel/walk/packet.hpp"

namespace grelha::GRELHA_ISA {

/// A ray as it walks grids.
struct WalkingRay {
  float org[3], dir[3], t_min, best;
  std::uint32_t id;
  int axis;  ///< of the shear
  /// inverse of the direction; this and what follows with triangles only, and a place more
  float inv[4];
  /// the side of a box that the ray meets first, along each axis; the other is 3 places on or back
  int near[4];
};

/// A ray by itself, tested in float.
struct Single : WalkingRay {
  using In = InFloat;
  float inv_dd;
  float shear[4];  ///< and a place more
};

/// A ray of a packet.
template <class In_>
struct PacketRay {
  using In = In_;
  Packet<In>& p;
  int i;
};

/// What tests take of a ray.
inline float tested_org(const Single& r, int axis) {
  return r.org[axis];
}
inline float direction(const Single& r, int axis) {
  return r.dir[axis];
}
inline float tested_t_min(const Single& r) {
  return r.t_min;
}
inline float tested_best(const Single& r) {
  return r.best;
}
inline float inverse_square(const Single& r) {
  return r.inv_dd;
}
inline float shear_of(const Single& r, int which) {
  return r.shear[which];
}
inline int axis_of(const Single& r) {
  return r.axis;
}
inline std::uint32_t id_of(const Single& r) {
  return r.id;
}
inline void set_hit(Single& r, float t, std::uint32_t id) {
  r.best = t;
  r.id = id;
}

template <class In>
inline typename In::Number tested_org(const PacketRay<In>& r, int axis) {
  return tested_org(r.p, axis)[r.i];
}
template <class In>
inline float direction(const PacketRay<In>& r, int axis) {
  return r.p.dir[axis][r.i];
}
template <class In>
inline float tested_t_min(const PacketRay<In>& r) {
  return tested_t_min(r.p)[r.i];
}
template <class In>
inline typename In::Number tested_best(const PacketRay<In>& r) {
  return tested_best(r.p)[r.i];
}
template <class In>
inline typename In::Number inverse_square(const PacketRay<In>& r) {
  return r.p.inv_dd[r.i];
}
template <class In>
inline typename In::Number shear_of(const PacketRay<In>& r, int which) {
  return r.p.shear[which][r.i];
}
template <class In>
inline int axis_of(const PacketRay<In>& r) {
  return static_cast<int>(r.p.axis[r.i]);
}
template <class In>
inline std::uint32_t id_of(const PacketRay<In>& r) {
  return id_of(r.p.id[r.i]);
}
template <class In>
inline void set_hit(const PacketRay<In>& r, typename In::Number t, std::uint32_t id) {
  set_best(r.p, r.i, t);
  r.p.id[r.i] = bits_of(id);
}

/// What tests of triangles need of a direction besides the shear.
inline void set_inverse(WalkingRay& r, const Vec3<float>& d) {
  const Four least = four(least_headway(d.x, d.y, d.z));
  const Four dir{d.x, d.y, d.z, 1};
  const Four inverse = four(1) / (magnitude(dir) < least ? least : dir);
  const FourInts low{0, 1, 2, 0};
  store(r.inv, inverse);
  store(r.near, inverse < four(0) ? low + 3 : low);
}

/// A ray by itself, as prepare(Packet&) makes many. False: it meets nothing, and r is not whole.
inline bool prepare(Single& r,
                    const Vec3<float>& org,
                    const Vec3<float>& d,
                    float t_min,
                    float t_max,
                    bool any_triangles) {
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
  r.inv_dd = 1 / dd;
  r.axis = 0;
  if (any_triangles) {
    r.axis = shear_axis(d.x, d.y, d.z);
    const Vec3<float> q = permuted<float>(static_cast<float>(r.axis), d);
    store(r.shear, Four{q.x, q.y, 1, 1} / four(q.z));
    set_inverse(r, d);
  }
  return true;
}

/// Takes one hit. Returns whether the search is over (kAny and something was hit).
template <bool kAny, class Ray, class Number>
[[gnu::always_inline]] inline bool take_hit(Ray& r, Number t, std::uint32_t id) {
  const Number best = tested_best(r);
  const bool closer = t < best;
  if (kAny) {
    if (closer)
      set_hit(r, Number(-kInfinity), id);
    return closer;
  }
  if (closer || (t == best && id_of(r) != kNoPrimitive && id < id_of(r)))
    set_hit(r, t, id);
  return false;
}

/// Takes the hits of a block in order of place. Returns whether the search is over.
template <bool kAny, class Ray>
inline bool note(Ray& r,
                 const Mask<typename Ray::In::Primitives>& hit,
                 const typename Ray::In::Primitives& t,
                 const std::uint32_t* ids) {
  using Real = typename Ray::In::Primitives;
  unsigned lanes = bits(both(hit, t <= Real(tested_best(r))));
  if (lanes == 0)
    return false;
  typename Ray::In::Number at[kWidth<Real>];
  store(at, t);
  for (; lanes != 0; lanes &= lanes - 1) {
    const int k = __builtin_ctz(lanes);
    if (take_hit<kAny>(r, at[k], ids[k]))
      return true;
  }
  return false;
}

/// Bits of the boxes that a ray passes through before its search ends, and where it enters them.
/// The ray is in the frame that begins at `corner`, when it comes kFromAfar.
template <bool kFromAfar = false>
inline unsigned passed_boxes(const WalkingRay& r,
                             const BlockBoxes& boxes,
                             float (&enters)[kBlock],
                             const float* corner = nullptr) {
  unsigned passed = 0;
  for (int i = 0; i < kBlock; i += kWidth<Block>) {
    Block enter(r.t_min), leave(r.best);
    for (int a = 0; a < 3; ++a) {
      const Block org(r.org[a]), inv(r.inv[a]);
      Block near = load<Block>(boxes.side[r.near[a]] + i);
      Block far = load<Block>(boxes.side[2 * a + 3 - r.near[a]] + i);
      if constexpr (kFromAfar) {
        near = near - Block(corner[a]);
        far = far - Block(corner[a]);
      }
      enter = greater((near - org) * inv, enter);
      leave = lesser((far - org) * inv, leave);
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

/// A ray and triangles of a block from i on.
template <class Ray>
struct RayAndBlock {
  using Real = typename Ray::In::Primitives;
  const Ray* r;
  const TriangleBlock* block;
  int i;
  RayAndTriangle<Real> operator()() const {
    const int k = axis_of(*r);
    const int kx = kNextAxis[k];
    const int ky = kPreviousAxis[k];
    const auto corner = [&](const float(&v)[3][kBlock]) {
      return Vec3<Real>{take<Real>(v[kx] + i), take<Real>(v[ky] + i), take<Real>(v[k] + i)};
    };
    return {{Real(tested_org(*r, kx)), Real(tested_org(*r, ky)), Real(tested_org(*r, k))},
            {Real(direction(*r, kx)), Real(direction(*r, ky)), Real(direction(*r, k))},
            {corner(block->a), corner(block->b), corner(block->c)}};
  }
};

/// In place of Counters where nobody asks for them: to clear those took up to a twentieth of a call
/// for one ray.
struct NoCounters {
  struct Nowhere {
    void operator+=(unsigned) const {}
  };
  Nowhere primitive_rows, tests[kKinds];
};

/// Counts rows of primitives that a ray is tested against.
template <class Shape, class Counts>
inline void count_rows(Counts& n, int rows, int width) {
  n.primitive_rows += static_cast<unsigned>(rows);
  n.tests[kNumber<Shape>] += static_cast<unsigned>(rows * width);
}

/// Callers count rows.
template <bool kAny, class Ray>
[[gnu::noinline]] bool test_block(Ray& r, const TriangleBlock& block) {
  using Real = typename Ray::In::Primitives;
  const Shear<Real> shear{Real(shear_of(r, 0)), Real(shear_of(r, 1)), Real(shear_of(r, 2))};
  const Real t_min(tested_t_min(r));
  for (int i = 0; i < kBlock; i += kWidth<Real>) {
    Real t(0);
    const Mask<Real> hit =
        hit_triangle<kAny>(RayAndBlock<Ray>{&r, &block, i}, shear, t_min, Real(tested_best(r)), t);
    if (note<kAny>(r, hit, t, block.id + i))
      return true;
  }
  return false;
}

/// One ray, for primitives side by side.
template <class Ray, class Real = typename Ray::In::Primitives>
[[gnu::always_inline]] inline RayLanes<Real> spread(const Ray& r) {
  return {.org = {Real(tested_org(r, 0)), Real(tested_org(r, 1)), Real(tested_org(r, 2))},
          .dir = {Real(direction(r, 0)), Real(direction(r, 1)), Real(direction(r, 2))},
          .inv_dd = Real(inverse_square(r)),
          .t_min = Real(tested_t_min(r))};
}

/// Primitives of one kind side by side, from place i of a list on; `ray` is r, spread. Returns
/// whether the search is over. Callers count rows.
template <bool kAny, class Shape, class Ray>
[[gnu::always_inline]] inline bool test_row(Ray& r,
                                            const RayLanes<typename Ray::In::Primitives>& ray,
                                            const typename Shape::CellList& list,
                                            std::uint32_t i) {
  using Real = typename Ray::In::Primitives;
  Real t(0);
  const Mask<Real> hit = meet(ray, side_by_side<Shape, Real>(list.fields, i), t);
  return note<kAny>(r, hit, t, list.id + i);
}

/// Primitives of one kind in one cell. Reading past its end meets those of the next, which costs
/// nothing and is never wrong: a hit is a hit.
template <bool kAny, class Shape, class Ray, class Counts>
[[gnu::always_inline]] inline bool test_list(Ray& r,
                                             const typename Shape::CellList& list,
                                             std::size_t cell,
                                             Counts& n) {
  using Real = typename Ray::In::Primitives;
  const RayLanes<Real> ray = spread(r);
  const std::uint32_t end = list.first[cell + 1];
  for (std::uint32_t i = list.first[cell]; i < end; i += kWidth<Real>) {
    count_rows<Shape>(n, 1, kWidth<Real>);
    if (test_row<kAny, Shape>(r, ray, list, i))
      return true;
  }
  return false;
}

/// Whether anything stands in arrays in some cell.
inline bool holds_arrays(const CellLists& lists) {
  bool some = false;
  ArrayShapes::for_each([&]<class Shape>() { some = some || lists.of<Shape>().first; });
  return some;
}

/// What stands in arrays in one cell.
template <bool kAny, class Ray, class Counts>
[[gnu::noinline]] bool test_arrays(Ray& r, const CellLists& lists, std::size_t cell, Counts& n) {
  bool over = false;
  ArrayShapes::for_each([&]<class Shape>() __attribute__((always_inline)) {
    const typename Shape::CellList& list = lists.of<Shape>();
    over = over || (list.first && test_list<kAny, Shape>(r, list, cell, n));
  });
  return over;
}

/// All primitives of one cell.
template <bool kAny, class Ray, class Counts>
inline bool test_cell(Ray& r, const CellLists& lists, std::size_t cell, Counts& n) {
  const Triangle::CellList& triangles = lists.of<Triangle>();
  if (triangles.first)
    for (std::uint32_t i = triangles.first[cell]; i < triangles.first[cell + 1]; ++i) {
      count_rows<Triangle>(n, 1, kBlock);
      if (test_block<kAny>(r, triangles.blocks[i]))
        return true;
    }
  return holds_arrays(lists) && test_arrays<kAny>(r, lists, cell, n);
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

template <class Number>
inline GridRay to_grid(const GridView& g, const Number (&org)[3], const float (&dir)[3]) {
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
