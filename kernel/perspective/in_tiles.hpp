#pragma once
// What is seen of primitives in tiles of their face, and as lists hold it: lane by lane.

#include "kernel/perspective/outline.hpp"
#include "kernel/perspective/seen.hpp"

namespace grelha::GRELHA_ISA {

/// From directions to tiles of a face.
template <class Real>
inline void to_tiles(const PointFace& f, Bounds<Real>& o) {
  const double per[2] = {
      f.per_u,
      f.per_v,
  };
  const double at[2] = {
      f.u,
      f.v,
  };
  for (int j = 0; j < 2; ++j) {
    o.lo[j] = (o.lo[j] - Real(at[j])) * Real(per[j]) - Real(kPlaceRounding);
    o.hi[j] = (o.hi[j] - Real(at[j])) * Real(per[j]) + Real(kPlaceRounding);
  }
  o.near = o.near - Real(f.depth);
  o.far = o.far - Real(f.depth);
}

/// The tile that bounds begin in, along an axis of `n` tiles, or the nearest one.
template <class Real>
inline Real anchor_of(const Real& lo, double n) {
  const Real whole(0x1p52);  // what is added to it loses its fraction
  const Real in = lesser(greater(lo, Real(0)), Real(n));
  const Real rounded = (in + whole) - whole;
  const Real below = select(rounded > in, rounded - Real(1), rounded);
  return lesser(below, Real(n > 1 ? n - 1 : 0));
}

/// Scales a side so that what it leaves open is 1.
template <class Real>
inline void scale_side(const PointFace& f, const Real& rounding, HalfPlane<Real>& s) {
  s.c = s.c + (s.a * Real(f.u) + s.b * Real(f.v));
  s.a = s.a * Real(1 / f.per_u);
  s.b = s.b * Real(1 / f.per_v);
  const Real margin = s.margin + rounding * (magnitude(s.a) + magnitude(s.b));
  const Real o(0);
  const Real scale = select(margin > o, Real(1) / margin, o);
  s.a = s.a * scale;
  s.b = s.b * scale;
  s.c = s.c * scale + Real(1);
}

/// The same with sides.
template <class Real>
inline void to_tiles(const PointFace& f, Outline<Real>& o) {
  to_tiles(f, static_cast<Bounds<Real>&>(o));
  const Real x = lesser(o.hi[0], Real(f.nx)) - anchor_of(o.lo[0], f.nx);
  const Real y = lesser(o.hi[1], Real(f.ny)) - anchor_of(o.lo[1], f.ny);
  const Real span = greater(greater(x, y), Real(1));
  const Real rounding = Real(kOutlineRounding) * (Real(1) + Real(kSpanRounding) * span);
  for (HalfPlane<Real>& s : o.side)
    scale_side(f, rounding, s);
}

/// Bounds of x by a side, at any y. Where it runs along x there are none: bounds of y say as much.
template <class Real>
inline void keep(const HalfPlane<Real>& side, int i, SeenSide& to) {
  const Real o(0);
  const Real never(1e300);
  const Real room(kPlaceRounding);
  const Mask<Real> up = side.a > o;
  const Mask<Real> down = side.a < o;
  const Real per = Real(-1) / side.a;
  store(to.b + i, side.b);
  store(to.c + i, side.c);
  store(to.per_lo + i, select(up, per, o));
  store(to.lo + i, o - select(up, room, never));
  store(to.per_hi + i, select(down, per, o));
  store(to.hi + i, select(down, room, never));
}

/// What is kept of bounds in tiles: of lanes from i on.
template <class Real>
inline void keep(const PointFace& f, const Bounds<Real>& o, int i, SeenFew& to) {
  const double n[2] = {
      f.nx,
      f.ny,
  };
  const Real room(kPlaceRounding);
  for (int j = 0; j < 2; ++j) {
    const Real anchor = anchor_of(o.lo[j], n[j]);
    store_narrow(to.last[j] + i, anchor_of(o.hi[j], n[j]));
    store(to.lo[j] + i, o.lo[j]);
    store(to.hi[j] + i, o.hi[j]);
    store_narrow(to.anchor[j] + i, anchor);
    store_not_above(to.box_lo[j] + i, o.lo[j] - anchor);
    store_not_below(to.box_hi[j] + i, o.hi[j] - anchor);
  }
  store_not_above(to.near + i, o.near);
  const Mask<Real> x = both(o.hi[0] >= Real(0) - room, o.lo[0] <= Real(f.nx) + room);
  const Mask<Real> y = both(o.hi[1] >= Real(0) - room, o.lo[1] <= Real(f.ny) + room);
  to.on_tiles |= bits(both(x, y)) << i;
}
/// The same with sides.
template <class Real>
inline void keep(const PointFace& f, const Outline<Real>& o, int i, SeenFew& to) {
  keep(f, static_cast<const Bounds<Real>&>(o), i, to);
  const Real x = anchor_of(o.lo[0], f.nx);
  const Real y = anchor_of(o.lo[1], f.ny);
  for (int s = 0; s < 3; ++s) {
    const HalfPlane<Real>& side = o.side[s];
    keep(side, i, to.side_of[s]);
    store_narrow(to.side[3 * s] + i, side.a);
    store_narrow(to.side[3 * s + 1] + i, side.b);
    store_narrow(to.side[3 * s + 2] + i, side.c + (side.a * x + side.b * y));
  }
  store_not_below(to.far + i, select(o.solid, o.far, Real(__builtin_inf())));
}

}  // namespace grelha::GRELHA_ISA
