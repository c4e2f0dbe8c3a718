#pragma once

#include "kernel/base/lanes.hpp"

namespace grelha::GRELHA_ISA {

/// Three components over Real (float, or one vector per SIMD lane).
template <class Real>
struct Vec3 {
  Real x, y, z;
};
using Vec3f = Vec3<float>;
using VFloat3 = Vec3<VFloat>;  ///< one vector per lane

/// A vector from an array of components.
template <class T>
[[gnu::always_inline]] inline Vec3<T> vec(const T (&v)[3]) {
  return {v[0], v[1], v[2]};
}

template <class Real>
inline Vec3<Real> operator+(const Vec3<Real>& a, const Vec3<Real>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Real>
inline Vec3<Real> operator-(const Vec3<Real>& a, const Vec3<Real>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Real>
inline Vec3<Real> operator*(const Vec3<Real>& a, const Vec3<Real>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class Real>
inline Vec3<Real> operator*(const Real& s, const Vec3<Real>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class Real>
inline Real dot(const Vec3<Real>& a, const Vec3<Real>& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
template <class Real>
inline Vec3<Real> cross(const Vec3<Real>& a, const Vec3<Real>& b) {
  return {
      a.y * b.z - a.z * b.y,
      a.z * b.x - a.x * b.z,
      a.x * b.y - a.y * b.x,
  };
}
/// The magnitude of each component.
template <class Real>
inline Vec3<Real> sizes(const Vec3<Real>& a) {
  return {magnitude(a.x), magnitude(a.y), magnitude(a.z)};
}
template <class Real>
inline Real length(const Vec3<Real>& a) {
  return square_root(dot(a, a));
}
/// Unit vector; (0,0,0) and lengths that underflow give NaN or infinity, which every comparison
/// then fails.
template <class Real>
inline Vec3<Real> normalize(const Vec3<Real>& a) {
  const Real s = Real(1) / length(a);
  return s * a;
}
template <class Real>
inline Vec3<Real> select(const Mask<Real>& m, const Vec3<Real>& a, const Vec3<Real>& b) {
  return {
      select(m, a.x, b.x),
      select(m, a.y, b.y),
      select(m, a.z, b.z),
  };
}
/// Part i of the lanes of each component, in double.
template <int i, class Real>
inline Vec3<Wide<Real>> to_double(const Vec3<Real>& a) {
  return {to_double<i>(a.x), to_double<i>(a.y), to_double<i>(a.z)};
}
/// Part i of doubles as sums of two floats, the second the rounding error of the first: 48 bits.
template <int i, class Real>
inline Vec3<Wide<Real>> to_double(const Vec3<Real>& a, const Vec3<Real>& low) {
  return to_double<i>(a) + to_double<i>(low);
}
/// Largest magnitude of the components.
template <class Real>
inline Real largest(const Vec3<Real>& a) {
  return max(max(magnitude(a.x), magnitude(a.y)), magnitude(a.z));
}

/// Two unit vectors across a third, by + - * / alone: Duff et al., "Building an Orthonormal Basis,
/// Revisited", 2017.
template <class Real>
inline void across(const Vec3<Real>& n, Vec3<Real>& u, Vec3<Real>& v) {
  const Real o(0), one(1), below(-1);
  const Real sign = select(n.z < o, below, one);
  const Real a = below / (sign + n.z);
  const Real b = n.x * n.y * a;
  u = {one + sign * n.x * n.x * a, sign * b, o - sign * n.x};
  v = {b, sign + n.y * n.y * a, o - n.y};
}

}  // namespace grelha::GRELHA_ISA
