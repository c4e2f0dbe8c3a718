#pragma once
// A point that is looked from, how far primitives are from it at least, and through which faces of
// a cube around it they are seen: lane by lane.

#include "kernel/perspective/view.hpp"
#include "kernel/shapes/cone.hpp"
#include "kernel/shapes/sphere.hpp"
#include "kernel/triangle/triangle.hpp"

namespace grelha {

/// A point, and how far what rays meet may lie from the primitive that it belongs to.
struct Viewpoint {
  double at[3];
  double pad;
  double aside;  ///< beside a triangle: inside or outside is decided in double there
};

/// The axes of a face.
struct FaceAxes {
  int p, q, r;  ///< its next axis, the one after, and its own
  bool down;    ///< against its own axis

  explicit FaceAxes(int face)
      : p((face / 2 + 1) % 3), q((face / 2 + 2) % 3), r(face / 2), down(face % 2) {}
};

}  // namespace grelha

namespace grelha::GRELHA_ISA {

/// A place as seen from a point, along x, y and z.
template <class Real>
inline Vec3<Real> relative(const Viewpoint& from, const Real (&x)[3]) {
  return {
      x[0] - Real(from.at[0]),
      x[1] - Real(from.at[1]),
      x[2] - Real(from.at[2]),
  };
}

/// A place or a direction turned to a face: x and y run along its next axis and the one after, z
/// along its own, outwards.
template <class Real>
[[gnu::always_inline]] inline Vec3<Real> turned(const Vec3<Real>& v, const FaceAxes& axes) {
  const Real c[3] = {
      v.x,
      v.y,
      v.z,
  };
  return {
      c[axes.p],
      c[axes.q],
      axes.down ? Real(0) - c[axes.r] : c[axes.r],
  };
}

/// The balls at the ends of a cone; it lies in their hull.
template <class Real>
struct Ends {
  Vec3<Real> center[2];
  Real radius[2];
};
template <class Real>
inline Ends<Real> ends_of(const Viewpoint& from, const Cone::Fields<Real>& c) {
  Ends<Real> e;
  e.center[0] = relative(from, c.base);
  e.radius[0] = c.radius;
  e.center[1] = e.center[0] + c.height * vec(c.axis);
  e.radius[1] = c.radius + c.slope * c.height;
  return e;
}

/// A primitive's box, from the point on.
template <class Real>
struct BoxAround {
  Vec3<Real> lo, hi;
};

template <class Real>
inline Vec3<Real> least(const Vec3<Real>& a, const Vec3<Real>& b) {
  return {
      lesser(a.x, b.x),
      lesser(a.y, b.y),
      lesser(a.z, b.z),
  };
}
template <class Real>
inline Vec3<Real> most(const Vec3<Real>& a, const Vec3<Real>& b) {
  return {
      greater(a.x, b.x),
      greater(a.y, b.y),
      greater(a.z, b.z),
  };
}

template <class Real>
inline BoxAround<Real> box_around(const Viewpoint& from, const Triangle::Fields<Real>& t) {
  const Vec3<Real> a = relative(from, t.corner[0]);
  const Vec3<Real> b = relative(from, t.corner[1]);
  const Vec3<Real> c = relative(from, t.corner[2]);
  return {least(least(a, b), c), most(most(a, b), c)};
}
template <class Real>
inline BoxAround<Real> box_around(const Viewpoint& from, const Sphere::Fields<Real>& s) {
  const Vec3<Real> center = relative(from, s.center);
  const Real r = magnitude(s.radius);
  const Vec3<Real> half{r, r, r};
  return {center - half, center + half};
}

/// Times its box's sides, all three: from there on a primitive is as far away as the box.
inline constexpr double kFarInBoxes = 4;

/// What a length is at least as the largest of three coordinates.
template <class Real>
inline Real as_largest(const Real& length) {
  return length * Real(.57735);
}

template <class Real>
inline Real own_distance(const Viewpoint& from, const Triangle::Fields<Real>& t) {
  const Vec3<Real> a = relative(from, t.corner[0]);
  const Vec3<Real> n = cross(relative(from, t.corner[1]) - a, relative(from, t.corner[2]) - a);
  const Real size = length(n);
  const Real o(0);
  return select(size > o, as_largest(magnitude(dot(a, n)) / size), o);
}
template <class Real>
inline Real own_distance(const Viewpoint& from, const Sphere::Fields<Real>& s) {
  return as_largest(length(relative(from, s.center)) - magnitude(s.radius));
}
template <class Real>
inline Real own_distance(const Viewpoint& from, const Cone::Fields<Real>& cone) {
  const Real o(0);
  const Ends<Real> e = ends_of(from, cone);
  const Vec3<Real> along = e.center[1] - e.center[0];
  const Real size = dot(along, along);
  const Real part = (o - dot(e.center[0], along)) / size;
  const Real at = select(size > o, lesser(greater(part, o), Real(1)), o);
  const Real axis = length(e.center[0] + at * along);
  return as_largest(axis - greater(e.radius[0], e.radius[1]));
}

/// How far a primitive is at least, as the largest of three coordinates. Kinds that have no
/// distance of their own are as far away as their box.
template <class Real, class Fields>
[[gnu::always_inline]] inline Real distance_of(const Viewpoint& from,
                                               const Fields& fields,
                                               const BoxAround<Real>& box) {
  const Real o(0);
  const Vec3<Real> back{
      o - box.hi.x,
      o - box.hi.y,
      o - box.hi.z,
  };
  const Vec3<Real> away = most(box.lo, back);
  const Real by_box = greater(greater(greater(away.x, away.y), away.z), o);
  if constexpr (requires { own_distance(from, fields); }) {
    const Vec3<Real> size = box.hi - box.lo;
    const Mask<Real> near = by_box <= Real(kFarInBoxes) * ((size.x + size.y) + size.z);
    if (any(near))
      return select(near, greater(own_distance(from, fields), by_box), by_box);
  }
  return by_box;
}

/// Sets the lanes of primitives that are seen through each face.
template <class Real>
inline void faces_of(const Viewpoint& from,
                     const BoxAround<Real>& box,
                     Mask<Real> (&seen)[kFaces]) {
  const Real o(0);
  const Real lo[3] = {
      box.lo.x,
      box.lo.y,
      box.lo.z,
  };
  const Real hi[3] = {
      box.hi.x,
      box.hi.y,
      box.hi.z,
  };
  Real away[3];  // along each axis
  for (int a = 0; a < 3; ++a)
    away[a] = greater(greater(lo[a], o - hi[a]), o);
  for (int a = 0; a < 3; ++a) {
    const Real beside = greater(away[(a + 1) % 3], away[(a + 2) % 3]) - Real(4 * from.pad);
    seen[2 * a] = hi[a] >= beside;
    seen[2 * a + 1] = o - lo[a] >= beside;
  }
}

}  // namespace grelha::GRELHA_ISA
