#pragma once
// Winding numbers in long double, by the angles between planes.

#include <cmath>
#include <numbers>

#include "tests/support/brute_force.hpp"

namespace grelha::test {

/// The solid angle of a triangle: the sum of the angles of the spherical one, less pi (Girard),
/// with the sign of the volume. The kernel has another formula.
inline oracle::Real solid_angle(const oracle::V& a, const oracle::V& b, const oracle::V& c) {
  using oracle::Real;
  using oracle::V;
  const V corner[3] = {a, b, c};
  Real sum = -std::numbers::pi_v<Real>;
  for (int k = 0; k < 3; ++k) {
    const V& at = corner[k];
    const V p = cross(at, corner[(k + 1) % 3]);
    const V q = cross(at, corner[(k + 2) % 3]);
    sum += std::atan2(length(cross(p, q)), dot(p, q));
  }
  return dot(cross(a, b), c) < 0 ? -sum : sum;
}

/// The same of a triangle that is small beside its distance, where Girard's sum cancels: the mean
/// of n r / |r|^3 by seven points, which is exact for polynomials of degree five (Radon 1948).
inline oracle::Real small_solid_angle(const oracle::V& a, const oracle::V& b, const oracle::V& c) {
  using oracle::Real;
  const oracle::V n = cross(b - a, c - a);
  const auto at = [&](Real u, Real v, Real w) {
    const oracle::V r = u * a + v * b + w * c;
    const Real distance = length(r);
    return dot(n, r) / (distance * distance * distance);
  };
  const Real root = std::sqrt(Real(15));
  Real sum = Real(9) / 40 * at(Real(1) / 3, Real(1) / 3, Real(1) / 3);
  for (const Real sign : {Real(-1), Real(1)}) {
    const Real u = (6 + sign * root) / 21;
    const Real w = 1 - 2 * u;
    sum += (155 + sign * root) / 1200 * (at(u, u, w) + at(u, w, u) + at(w, u, u));
  }
  return sum / 2;
}

/// The winding number of a mesh around a point that lies on none of its planes, by the solid angle
/// of each triangle.
template <class SolidAngle>
oracle::Real winding_number(const Triangles& t,
                            const Float3& point,
                            const SolidAngle& solid_angle) {
  const oracle::V p = brute::v(point);
  oracle::Real sum = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const auto at = [&](std::uint32_t v) { return brute::v(t.x[v], t.y[v], t.z[v]) - p; };
    sum += solid_angle(at(t.a[i]), at(t.b[i]), at(t.c[i]));
  }
  return sum / (4 * std::numbers::pi_v<oracle::Real>);
}
inline oracle::Real winding_number(const Triangles& t, const Float3& point) {
  return winding_number(t, point, solid_angle);
}

}  // namespace grelha::test
