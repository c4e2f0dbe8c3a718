#pragma once

#include <cmath>

namespace grelha::scenes {

/// Double vectors for constructions: a scene is computed once and printed with six digits, so speed
/// is no matter here.
struct Vec {
  double x = 0, y = 0, z = 0;
  bool operator==(const Vec&) const = default;
};

inline Vec operator+(Vec a, Vec b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec operator-(Vec a, Vec b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec operator*(double s, Vec v) {
  return {s * v.x, s * v.y, s * v.z};
}
inline double dot(Vec a, Vec b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec cross(Vec a, Vec b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec v) {
  return std::sqrt(dot(v, v));
}
inline Vec normalise(Vec v) {
  return 1 / length(v) * v;
}

/// `v` turned about the unit vector `axis`, counter-clockwise seen against it (Rodrigues).
inline Vec turn(Vec v, Vec axis, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return c * v + s * cross(axis, v) + (1 - c) * dot(axis, v) * axis;
}

inline constexpr double kPi = 3.14159265358979323846;
inline double degrees(double d) {
  return d * kPi / 180;
}

}  // namespace grelha::scenes
