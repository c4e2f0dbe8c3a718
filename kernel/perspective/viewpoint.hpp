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

/// The axes of a face.
struct FaceAxes {
  int p, q, r;
  bool down;  ///< against its own axis

  explicit FaceAxes(int face)
      : p(kNext[face / 2]), q(kLast[face / 2]), r(face / 2), down(face % 2) {}

 private:
  static constexpr int kNext[3] = {1, 2, 0};
  static constexpr int kLast[3] = {2, 0, 1};
};

/// A place or a direction along the axes of a face.
template <class T>
FacePoint relative(const Viewpoint& from, const T (&x)[3], const FaceAxes& axes) {
  const double r = x[axes.r] - from.at[axes.r];
  return {
      x[axes.p] - from.at[axes.p],
      x[axes.q] - from.at[axes.q],
      axes.down ? -r : r,
  };
}
inline FacePoint turned(const Vector& x, int face) {
  const double c[3] = {
      x.p,
      x.q,
      x.r,
  };
  const FaceAxes axes(face);
  return {
      c[axes.p],
      c[axes.q],
      axes.down ? -c[axes.r] : c[axes.r],
  };
}

}  // namespace grelha
