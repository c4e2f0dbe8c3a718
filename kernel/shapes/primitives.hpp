#pragma once
// What stands in grids, and the boxes it stands in.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "grelha/scene_spans.hpp"

namespace grelha {

/// Axis-aligned box in double, where sums of floats do not round. Empty when lo > hi.
struct Box {
  double lo[3] = {1e300, 1e300, 1e300}, hi[3] = {-1e300, -1e300, -1e300};
  void add(double x, double y, double z) {
    const double p[3] = {x, y, z};
    for (int a = 0; a < 3; ++a) {
      if (p[a] < lo[a])
        lo[a] = p[a];
      if (p[a] > hi[a])
        hi[a] = p[a];
    }
  }
  void add(const Box& b) {
    add(b.lo[0], b.lo[1], b.lo[2]);
    add(b.hi[0], b.hi[1], b.hi[2]);
  }
  bool empty() const { return !(lo[0] <= hi[0]); }
  void grow(double by) {
    for (int a = 0; a < 3; ++a) {
      lo[a] -= by;
      hi[a] += by;
    }
  }
  double diagonal() const {
    if (empty())
      return 0;
    double sum = 0;
    for (int a = 0; a < 3; ++a)
      sum += (hi[a] - lo[a]) * (hi[a] - lo[a]);
    return std::sqrt(sum);
  }
};

/// Cones as the tests want them, see ConeSide: base xyz, axis xyz, height, radius, slope, side;
/// [count] each.
using PreparedCones = std::array<std::vector<float>, 10>;
PreparedCones prepare_cones(const ConeSpans& cones);

/// The caller's arrays with what is derived from them; ids run over planes, spheres, triangles,
/// cones.
struct Primitives {
  GeometrySpans geometry;
  PreparedCones cones;
  std::uint32_t sphere_base, triangle_base, cone_base, end;
  explicit Primitives(const GeometrySpans& geometry);
  /// Of a finite primitive (id >= sphere_base).
  Box box(std::uint32_t id) const {
    return id < triangle_base ? sphere_box(id - sphere_base) : flat_box(id);
  }

 private:
  Box sphere_box(std::size_t i) const {
    const SphereSpans& s = geometry.spheres;
    const double center[3] = {s.x[i], s.y[i], s.z[i]},
                 radius = s.radius[i] < 0 ? -s.radius[i] : s.radius[i];
    Box b;
    for (int a = 0; a < 3; ++a) {
      b.lo[a] = center[a] - radius;
      b.hi[a] = center[a] + radius;
    }
    return b;
  }
  Box flat_box(std::uint32_t id) const;  ///< of a triangle or a cone
};

enum class Kind { kSphere, kTriangle, kCone };

inline Kind kind_of(const Primitives& p, std::uint32_t id) {
  return id < p.triangle_base ? Kind::kSphere : id < p.cone_base ? Kind::kTriangle : Kind::kCone;
}

struct Corners {
  double v[3][3];
};

inline Corners corners_of(const Primitives& p, std::uint32_t id) {
  const TriangleSpans& t = p.geometry.triangles;
  const std::uint32_t i = id - p.triangle_base, v[3] = {t.a[i], t.b[i], t.c[i]};
  Corners c;
  for (int k = 0; k < 3; ++k) {
    c.v[k][0] = t.x[v[k]];
    c.v[k][1] = t.y[v[k]];
    c.v[k][2] = t.z[v[k]];
  }
  return c;
}

inline Box box_of(const Corners& c) {
  Box b;
  for (int a = 0; a < 3; ++a) {
    b.lo[a] = std::min(std::min(c.v[0][a], c.v[1][a]), c.v[2][a]);
    b.hi[a] = std::max(std::max(c.v[0][a], c.v[1][a]), c.v[2][a]);
  }
  return b;
}

}  // namespace grelha
