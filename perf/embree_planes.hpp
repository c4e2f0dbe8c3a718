#pragma once
// Planes as squares, which other tracers know.

#include <algorithm>
#include <cmath>

#include "grelha/geometry.hpp"

namespace grelha::perf {

struct Range {
  double lo[3] = {1e300, 1e300, 1e300}, hi[3] = {-1e300, -1e300, -1e300};
  void add(double x, double y, double z, double r = 0) {
    const double p[3] = {x, y, z};
    for (int a = 0; a < 3; ++a) {
      lo[a] = std::min(lo[a], p[a] - r);
      hi[a] = std::max(hi[a], p[a] + r);
    }
  }
  double width() const { return std::max({hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]}); }
};

/// Of all but the planes.
inline Range range_of(const Geometry& scene) {
  const Spheres& s = scene.spheres;
  const Triangles& t = scene.triangles;
  const Cones& c = scene.cones;
  Range all;
  for (std::size_t i = 0; i < s.size(); ++i)
    all.add(s.x[i], s.y[i], s.z[i], std::abs(s.radius[i]));
  for (std::size_t i = 0; i < t.vertex_count(); ++i)
    all.add(t.x[i], t.y[i], t.z[i]);
  for (std::size_t i = 0; i < c.size(); ++i) {
    all.add(c.base_x[i], c.base_y[i], c.base_z[i]);
    all.add(c.apex_x[i], c.apex_y[i], c.apex_z[i]);
  }
  return all;
}

/// Its middle, and the unit directions of its sides.
struct Square {
  double middle[3], u[3], w[3];
};

inline void normalize(double (&v)[3]) {
  const double length = std::hypot(v[0], v[1], v[2]);
  for (double& x : v)
    x /= length;
}

/// A unit direction across the unit direction n: of the axis that is furthest from it, the part
/// across.
inline void across_unit(const double (&n)[3], double (&u)[3]) {
  int least = 0;
  for (int a = 1; a < 3; ++a)
    if (std::abs(n[a]) < std::abs(n[least]))
      least = a;
  for (int a = 0; a < 3; ++a)
    u[a] = (a == least ? 1 : 0) - n[least] * n[a];
  normalize(u);
}

/// About the middle of the range, as it falls onto plane i.
inline Square square_on_plane(const Planes& p, std::size_t i, const Range& all) {
  double n[3] = {p.nx[i], p.ny[i], p.nz[i]};
  const double at[3] = {p.x[i], p.y[i], p.z[i]};
  normalize(n);
  Square s;
  double along = 0;
  for (int a = 0; a < 3; ++a) {
    s.middle[a] = (all.lo[a] + all.hi[a]) / 2;
    along += n[a] * (s.middle[a] - at[a]);
  }
  across_unit(n, s.u);
  for (int a = 0; a < 3; ++a) {
    s.middle[a] -= along * n[a];
    s.w[a] = n[(a + 1) % 3] * s.u[(a + 2) % 3] - n[(a + 2) % 3] * s.u[(a + 1) % 3];
  }
  return s;
}

/// Four corners of three floats; sides of twice `half`.
inline void put_square(const Square& s, double half, float* v) {
  constexpr int kAlongU[4] = {-1, 1, 1, -1}, kAlongW[4] = {-1, -1, 1, 1};
  for (int k = 0; k < 4; ++k)
    for (int a = 0; a < 3; ++a)
      *v++ = static_cast<float>(s.middle[a] + half * (kAlongU[k] * s.u[a] + kAlongW[k] * s.w[a]));
}

}  // namespace grelha::perf
