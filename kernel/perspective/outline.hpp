#pragma once
// What primitives look like from a point, on one face of a cube around it: lane by lane.

#include "kernel/perspective/tolerances.hpp"
#include "kernel/perspective/viewpoint.hpp"

namespace grelha::GRELHA_ISA {

/// Where a ray through the point may meet a primitive.
template <class Real>
struct Bounds {
  Real lo[2], hi[2];  ///< of directions (u, v, 1)
  Real near, far;     ///< along the face's axis
};

/// Directions (u, v, 1) with a u + b v + c >= -margin.
template <class Real>
struct HalfPlane {
  Real a = Real(0);
  Real b = Real(0);
  Real c = Real(1);
  Real margin = Real(0);
};

/// The same, more closely.
template <class Real>
struct Outline : Bounds<Real> {
  HalfPlane<Real> side[3];
  /// rays further inside of all sides than they leave open meet it for sure, between near and far
  Mask<Real> solid;
};

/// What primitives are seen through, and how far away each is at least: kNearest pads and more.
template <class Real>
struct Look {
  const Viewpoint& from;
  FaceAxes axes;
  Real distance;

  /// What rays meet may lie beside a primitive: its parts are seen from here on.
  Real front() const { return distance - Real(2 * from.pad); }
};

template <class Real>
inline void clear(Bounds<Real>& o) {
  for (int j = 0; j < 2; ++j) {
    o.lo[j] = Real(1e300);
    o.hi[j] = Real(-1e300);
  }
  o.near = Real(1e300);
  o.far = Real(-1e300);
}

template <class Real>
inline Mask<Real> no_lane() {
  return Real(0) != Real(0);
}

/// Widens bounds to a point's place, which has depth > 0, in chosen lanes.
template <class Real>
[[gnu::always_inline]] inline void add(Bounds<Real>& o, const Vec3<Real>& x, const Mask<Real>& to) {
  const Real inverse = Real(1) / x.z;
  const Real place[2] = {
      x.x * inverse,
      x.y * inverse,
  };
  for (int j = 0; j < 2; ++j) {
    o.lo[j] = select(to, lesser(o.lo[j], place[j]), o.lo[j]);
    o.hi[j] = select(to, greater(o.hi[j], place[j]), o.hi[j]);
  }
  o.near = select(to, lesser(o.near, x.z), o.near);
  o.far = select(to, greater(o.far, x.z), o.far);
}

/// Grows bounds by what rays may miss a primitive by, `aside` and along, and cuts them to the face.
/// False: nothing is left.
template <class Real>
[[gnu::always_inline]] inline Mask<Real> finish(Bounds<Real>& o,
                                                const Look<Real>& look,
                                                double aside) {
  const Real pad(look.from.pad);
  const Real grow = Real(2 * aside) / look.front();
  for (int j = 0; j < 2; ++j) {
    o.lo[j] = greater(o.lo[j] - grow, Real(-1));
    o.hi[j] = lesser(o.hi[j] + grow, Real(1));
  }
  const Mask<Real> some = both(o.lo[0] <= o.hi[0], o.lo[1] <= o.hi[1]);
  const Mask<Real> seen = both(some, o.far >= look.front());
  o.near = greater(o.near - pad, look.distance - pad);
  o.far = o.far + pad;
  return seen;
}

/// What a side leaves open, over the length of its normal.
template <class Real>
inline Real side_margin(double pad, const Real& distance) {
  return Real(pad) / (distance - Real(pad));
}

/// n: across the side, towards what is seen. Lanes that are not chosen get one that holds all.
template <class Real>
inline HalfPlane<Real> half_plane(const Mask<Real>& chosen,
                                  const Vec3<Real>& n,
                                  const Real& margin) {
  const Real o(0);
  return {
      select(chosen, n.x, o),
      select(chosen, n.y, o),
      select(chosen, n.z, Real(1)),
      select(chosen, margin, o),
  };
}

/// Widens bounds to what of a triangle is deep enough.
template <class Real>
[[gnu::always_inline]] inline void bound(Bounds<Real>& o,
                                         const Vec3<Real> (&c)[3],
                                         const Real& front) {
  clear(o);
  const Mask<Real> deep[3] = {
      c[0].z >= front,
      c[1].z >= front,
      c[2].z >= front,
  };
  for (int k = 0; k < 3; ++k)
    add(o, c[k], deep[k]);
  const Mask<Real> all = both(both(deep[0], deep[1]), deep[2]);
  if (none(but_not(either(either(deep[0], deep[1]), deep[2]), all)))
    return;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const Vec3<Real>&a = c[k], &b = c[next];
    const Real way = (front - a.z) / (a.z - b.z);
    const Mask<Real> cut = but_not(either(deep[k], deep[next]), both(deep[k], deep[next]));
    add(o, a - way * (b - a), cut);
  }
}

/// What cross(a, edge) is off by, see kNormalRounding.
template <class Real>
inline Real normal_rounding(const Vec3<Real>& a, const Vec3<Real>& edge) {
  return Real(kNormalRounding) * square_root(dot(a, a) * dot(edge, edge));
}

/// The sides of a triangle, where doubles tell on which side of each it lies.
template <class Real>
[[gnu::always_inline]] inline void set_sides(Outline<Real>& o,
                                             const Vec3<Real> (&c)[3],
                                             const Real& margin) {
  // What the corners span with the point: each lies on one side of the plane of the others. Seen
  // from the edge, nobody knows on which.
  const Vec3<Real> first = c[1] - c[0];
  const Real volume = dot(cross(c[0], first), c[2]);
  const Real unsure = normal_rounding(c[0], first) * length(c[2]);
  o.solid = magnitude(volume) > unsure;
  const Real towards = select(volume > Real(0), Real(1), Real(-1));
  for (int k = 0; k < 3; ++k) {
    const Vec3<Real>& a = c[k];
    const Vec3<Real> edge = c[(k + 1) % 3] - a;
    const Vec3<Real> n = cross(a, edge);
    const Real open = margin * length(n) + normal_rounding(a, edge);
    o.side[k] = half_plane(o.solid, towards * n, open);
  }
}

/// What is seen of primitives through a face; false: nothing.
template <class Real>
[[gnu::always_inline]] inline Mask<Real> see(const Look<Real>& look,
                                             const Triangle::Fields<Real>& t,
                                             Outline<Real>& o) {
  Vec3<Real> c[3];
  for (int k = 0; k < 3; ++k)
    c[k] = turned(relative(look.from, t.corner[k]), look.axes);
  bound(o, c, look.front());
  const Mask<Real> seen = finish(o, look, look.from.aside);
  set_sides(o, c, side_margin(look.from.aside, look.distance));
  return seen;
}

/// A ball of what may be met, its centre turned to a face.
template <class Real>
struct TurnedBall {
  Vec3<Real> center;
  Real radius;
};

/// Widens bounds along axis j to a ball in front of `front`: to its tangents where all of it is in
/// front of the point, else to its box between depths near and far.
template <class Real>
inline void add_ball_along(
    Bounds<Real>& o, int j, const TurnedBall<Real>& b, const Real& near, const Real& far) {
  const Real zero(0);
  const Real depth = b.center.z;
  const Real x = j == 0 ? b.center.x : b.center.y;
  const Real across = depth * depth - b.radius * b.radius;
  const Real root = b.radius * square_root(greater(x * x + across, zero));
  const Mask<Real> whole = both(depth > b.radius, across > zero);
  const Real inverse = Real(1) / across;
  const Real lo = x - b.radius;
  const Real hi = x + b.radius;
  const Real lo_of_box = lo / select(lo < zero, near, far);
  const Real hi_of_box = hi / select(hi > zero, near, far);
  o.lo[j] = lesser(o.lo[j], select(whole, (x * depth - root) * inverse, lo_of_box));
  o.hi[j] = greater(o.hi[j], select(whole, (x * depth + root) * inverse, hi_of_box));
}
template <class Real>
inline void add_ball(Bounds<Real>& o, const TurnedBall<Real>& b, const Real& front) {
  const Real near = greater(b.center.z - b.radius, front);
  const Real far = b.center.z + b.radius;
  o.near = lesser(o.near, near);
  o.far = greater(o.far, far);
  for (int j = 0; j < 2; ++j)
    add_ball_along(o, j, b, near, far);
}

template <class Real>
[[gnu::always_inline]] inline Mask<Real> see(const Look<Real>& look,
                                             const Sphere::Fields<Real>& s,
                                             Bounds<Real>& o) {
  clear(o);
  const Vec3<Real> center = turned(relative(look.from, s.center), look.axes);
  add_ball(o, {center, magnitude(s.radius)}, look.front());
  return finish(o, look, look.from.pad);
}

/// Bounds of what of a box turned to a face is deep enough.
template <class Real>
inline void add_box(Bounds<Real>& o, const BoxAround<Real>& box, const Real& front) {
  const Real zero(0);
  o.near = greater(box.lo.z, front);
  o.far = box.hi.z;
  const Real at_near = Real(1) / o.near;
  const Real at_far = Real(1) / o.far;
  const Real lo[2] = {
      box.lo.x,
      box.lo.y,
  };
  const Real hi[2] = {
      box.hi.x,
      box.hi.y,
  };
  for (int j = 0; j < 2; ++j) {
    o.lo[j] = lo[j] * select(lo[j] < zero, at_near, at_far);
    o.hi[j] = hi[j] * select(hi[j] > zero, at_near, at_far);
  }
}

/// What of a box may be met.
template <class Real>
[[gnu::always_inline]] inline Mask<Real> see_box(const Look<Real>& look,
                                                 const BoxAround<Real>& box,
                                                 Bounds<Real>& o) {
  const Vec3<Real> a = turned(box.lo, look.axes);
  const Vec3<Real> b = turned(box.hi, look.axes);
  add_box(o, {least(a, b), most(a, b)}, look.front());
  return finish(o, look, look.from.pad);
}

/// The planes through the point that touch both balls at the ends of a cone.
template <class Real>
inline void add_sides(Outline<Real>& o, const Look<Real>& look, const Ends<Real>& e) {
  // n = x c0 + y c1 +- z (c0 x c1), |n| = 1, n . c = radius at both ends
  const Vec3<Real>(&c)[2] = e.center;
  const Vec3<Real> across = cross(c[0], c[1] - c[0]);
  const Real g00 = dot(c[0], c[0]);
  const Real g01 = dot(c[0], c[1]);
  const Real g11 = dot(c[1], c[1]);
  const Real det = dot(across, across);
  const Real pad(look.from.pad);
  const Real r0 = e.radius[0] + pad;
  const Real r1 = e.radius[1] + pad;
  const Real x = (r0 * g11 - r1 * g01) / det;
  const Real y = (r1 * g00 - r0 * g01) / det;
  const Vec3<Real> in = x * c[0] + y * c[1];
  const Real rest = Real(1) - dot(in, in);
  const Mask<Real> wide = both(det > Real(kNarrowestCone) * g00 * g11, rest > Real(0));
  const Vec3<Real> out = square_root(rest / det) * across;
  const Real margin = side_margin(look.from.pad, look.distance);
  o.side[0] = half_plane(wide, in + out, margin);
  o.side[1] = half_plane(wide, in - out, margin);
}

/// The plane through the point that touches the wider ball across the axis, where both lie on the
/// same side of it: with the two along the cone a triangle.
template <class Real>
inline void add_end(Outline<Real>& o, const Look<Real>& look, const Ends<Real>& e) {
  const Mask<Real> first = e.radius[0] >= e.radius[1];
  const Vec3<Real> wide = select(first, e.center[0], e.center[1]);
  const Vec3<Real> narrow = select(first, e.center[1], e.center[0]);
  const Real pad(look.from.pad);
  const Real r = greater(e.radius[0], e.radius[1]) + pad;
  const Real far = dot(wide, wide);
  const Vec3<Real> across = narrow - (dot(narrow, wide) / far) * wide;
  const Real beside = far - r * r;
  // n = (r wide / |wide| + sqrt(|wide|^2 - r^2) across / |across|) / |wide|
  const Real along = square_root(beside / (far * dot(across, across)));
  const Vec3<Real> n = (r / far) * wide + along * across;
  const Mask<Real> touches =
      both(beside > Real(0), dot(across, across) > Real(kNarrowestCone) * dot(narrow, narrow));
  const Mask<Real> same_side = dot(n, narrow) >= lesser(e.radius[0], e.radius[1]) + pad;
  o.side[2] = half_plane(both(touches, same_side), n, side_margin(look.from.pad, look.distance));
}

template <class Real>
inline Mask<Real> see(const Look<Real>& look, const Cone::Fields<Real>& cone, Outline<Real>& o) {
  Ends<Real> e = ends_of(look.from, cone);
  const Real front = look.front();
  Vec3<Real> half[2];
  for (int i = 0; i < 2; ++i) {
    e.center[i] = turned(e.center[i], look.axes);
    half[i] = {
        e.radius[i],
        e.radius[i],
        e.radius[i],
    };
  }
  Bounds<Real> balls, box;
  clear(balls);
  for (int i = 0; i < 2; ++i)
    add_ball<Real>(balls, {e.center[i], e.radius[i]}, front);
  const Vec3<Real> lo = least(e.center[0] - half[0], e.center[1] - half[1]);
  const Vec3<Real> hi = most(e.center[0] + half[0], e.center[1] + half[1]);
  add_box<Real>(box, {lo, hi}, front);
  const Mask<Real> whole =
      both(e.center[0].z - e.radius[0] >= front, e.center[1].z - e.radius[1] >= front);
  for (int j = 0; j < 2; ++j) {
    o.lo[j] = select(whole, balls.lo[j], box.lo[j]);
    o.hi[j] = select(whole, balls.hi[j], box.hi[j]);
  }
  o.near = select(whole, balls.near, box.near);
  o.far = select(whole, balls.far, box.far);
  o.solid = no_lane<Real>();
  add_sides(o, look, e);
  add_end(o, look, e);
  return finish(o, look, look.from.pad);
}

}  // namespace grelha::GRELHA_ISA
