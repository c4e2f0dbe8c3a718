#pragma once
// Rods: straight bounds of the things that are sampled individually.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "grelha/scene_spans.hpp"

namespace grelha {

struct Point3 {
  double at[3];
  double operator[](std::size_t a) const { return at[a]; }
  double& operator[](std::size_t a) { return at[a]; }
  bool operator==(const Point3&) const = default;
};
inline Point3 operator-(const Point3& a, const Point3& b) {
  return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}};
}
inline double dot(const Point3& a, const Point3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Point3 cross(const Point3& a, const Point3& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

/// All of a thing lies within `radius` of the stretch between its ends.
struct Rod {
  Point3 end[2];
  double radius;
  std::uint32_t material;

  double length() const { return std::sqrt(dot(end[1] - end[0], end[1] - end[0])); }
};

inline Rod rod_of(const SphereSpans& s, std::size_t i) {
  const Point3 centre{{s.x[i], s.y[i], s.z[i]}};
  return {{centre, centre}, std::abs(static_cast<double>(s.radius[i])), s.material[i]};
}

inline Rod rod_of(const ConeSpans& c, std::size_t i) {
  return {{{{c.base_x[i], c.base_y[i], c.base_z[i]}}, {{c.apex_x[i], c.apex_y[i], c.apex_z[i]}}},
          std::max(std::abs(static_cast<double>(c.base_radius[i])),
                   std::abs(static_cast<double>(c.apex_radius[i]))),
          c.material[i]};
}

inline Point3 corner_of(const TriangleSpans& t, std::uint32_t vertex) {
  return {{t.x[vertex], t.y[vertex], t.z[vertex]}};
}

}  // namespace grelha
