#pragma once

#include <array>
#include <cmath>

#include "grelha/geometry.hpp"

namespace grelha {

/// A vector in double: differences of nearby floats are exact in it.
using Double3 = std::array<double, 3>;

inline Double3 in_double(const Float3& v) {
  return {v.x, v.y, v.z};
}
inline Float3 in_floats(const Double3& v) {
  return {float(v[0]), float(v[1]), float(v[2])};
}
/// From b to a.
inline Double3 difference(const Float3& a, const Float3& b) {
  return {double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z};
}
/// s a + t b.
inline Double3 sum(double s, const Double3& a, double t, const Double3& b) {
  return {s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]};
}
inline Double3 cross(const Double3& a, const Double3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double dot(const Double3& a, const Double3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline double length(const Double3& a) {
  return std::sqrt(dot(a, a));
}

/// Returns true if the vector is zero in floats: no area, or no direction.
inline bool is_zero(const Double3& a) {
  return float(a[0]) == 0 && float(a[1]) == 0 && float(a[2]) == 0;
}

}  // namespace grelha
