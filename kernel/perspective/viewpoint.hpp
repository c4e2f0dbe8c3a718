#pragma once
// A point that is looked from, and places around it.

#include <cmath>

namespace grelha {

/// A point, and how far what rays meet may lie from the primitive that it belongs to.
struct Viewpoint {
  double at[3];
  double pad;
  double aside;  ///< beside a triangle: inside or outside is decided in double there
};

/// Coordinates on a face: along its next axis, the one after, and its own, outwards.
struct FacePoint {
  double p, q, r;
};

/// Or a direction, and before it is turned to a face: along x, y and z.
using Vector = FacePoint;

inline Vector operator-(const Vector& a, const Vector& b) {
  return {
      a.p - b.p,
      a.q - b.q,
      a.r - b.r,
  };
}
inline double dot(const Vector& a, const Vector& b) {
  return a.p * b.p + a.q * b.q + a.r * b.r;
}
inline double length(const Vector& a) {
  return std::sqrt(dot(a, a));
}
inline Vector cross(const Vector& a, const Vector& b) {
  return {
      a.q * b.r - a.r * b.q,
      a.r * b.p - a.p * b.r,
      a.p * b.q - a.q * b.p,
  };
}
inline Vector scaled(double s, const Vector& a) {
  return {
      s * a.p,
      s * a.q,
      s * a.r,
  };
}

template <class T>
Vector relative(const Viewpoint& from, const T (&x)[3]) {
  return {
      x[0] - from.at[0],
      x[1] - from.at[1],
      x[2] - from.at[2],
  };
}

/// Turned to the axes of a face.
inline Vector turned(const Vector& x, int face) {
  const double c[3] = {
      x.p,
      x.q,
      x.r,
  };
  const int a = face / 2;
  return {
      c[(a + 1) % 3],
      c[(a + 2) % 3],
      face % 2 == 0 ? c[a] : -c[a],
  };
}

}  // namespace grelha
