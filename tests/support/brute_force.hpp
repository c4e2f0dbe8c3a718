#pragma once
// Crossings and distances of every primitive of a scene in long double: no grid, no SIMD, none of
// the kernel's arithmetic.

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "grelha/rays.hpp"
#include "grelha/scene_spans.hpp"
#include "tests/support/oracle.hpp"

namespace grelha::test::brute {

using oracle::Real;
using oracle::V;

struct Crossing {
  Real t;
  std::uint32_t id;
};

/// The crossings of a ray, in order of t. `is_clear` is false where a crossing is so near an edge
/// or an end that rounding may decide.
struct Crossings {
  std::vector<Crossing> list;
  bool is_clear = true;
};

inline V v(const Float3& p) {
  return {p.x, p.y, p.z};
}
inline V v(float x, float y, float z) {
  return {x, y, z};
}

/// Corners of triangle i.
struct Corners {
  V a, b, c;
  Corners(const Triangles& t, std::size_t i)
      : a(v(t.x[t.a[i]], t.y[t.a[i]], t.z[t.a[i]])),
        b(v(t.x[t.b[i]], t.y[t.b[i]], t.z[t.b[i]])),
        c(v(t.x[t.c[i]], t.y[t.c[i]], t.z[t.c[i]])) {}
};

class RayThroughScene {
 public:
  RayThroughScene(const Scene& s, const Ray& ray)
      : org_(v(ray.org)), dir_(v(ray.dir)), t_min_(ray.t_min), t_max_(ray.t_max) {
    const Geometry& g = s.geometry;
    std::uint32_t id = 0;
    for (std::size_t i = 0; i < g.planes.size(); ++i)
      plane(g.planes, i, id++);
    for (std::size_t i = 0; i < g.spheres.size(); ++i)
      sphere(g.spheres, i, id++);
    for (std::size_t i = 0; i < g.triangles.size(); ++i)
      triangle(Corners(g.triangles, i), id++);
    for (std::size_t i = 0; i < g.cones.size(); ++i)
      cone(g.cones, i, id++);
    std::sort(found_.list.begin(), found_.list.end(), [](const Crossing& a, const Crossing& b) {
      return a.t != b.t ? a.t < b.t : a.id < b.id;
    });
  }
  const Crossings& crossings() const { return found_; }

 private:
  static constexpr Real kNear = 1e-5L;

  void add(Real t, std::uint32_t id) {
    if (std::fabs(t - t_min_) < kNear || std::fabs(t - t_max_) < kNear)
      found_.is_clear = false;
    if (t > t_min_ && t < t_max_)
      found_.list.push_back({t, id});
  }
  void plane(const Planes& p, std::size_t i, std::uint32_t id) {
    const V n = v(p.nx[i], p.ny[i], p.nz[i]);
    const Real along = dot(dir_, n);
    if (std::fabs(along) < kNear)
      found_.is_clear = false;
    else
      add(dot(v(p.x[i], p.y[i], p.z[i]) - org_, n) / along, id);
  }
  void sphere(const Spheres& s, std::size_t i, std::uint32_t id) {
    const V to = v(s.x[i], s.y[i], s.z[i]) - org_;
    const Real r = s.radius[i], dd = dot(dir_, dir_), b = dot(to, dir_) / dd;
    const Real root = b * b - (dot(to, to) - r * r) / dd;
    if (std::fabs(root) < kNear * r * r)
      found_.is_clear = false;
    if (root <= 0)
      return;
    if (r > 0)
      add(b - std::sqrt(root), id);
    add(b + std::sqrt(root), id);
  }
  void triangle(const Corners& c, std::uint32_t id) {
    const V e = c.b - c.a, f = c.c - c.a, p = cross(dir_, f), to = org_ - c.a, q = cross(to, e);
    const Real det = dot(e, p);
    if (std::fabs(det) < 1e-9L) {
      found_.is_clear = false;
      return;
    }
    const Real x = dot(to, p) / det, y = dot(dir_, q) / det, z = 1 - x - y;
    const Real least = std::min(x, std::min(y, z));
    if (std::fabs(least) < kNear)
      found_.is_clear = false;
    if (least > 0)
      add(dot(f, q) / det, id);
  }
  void cone(const Cones& s, std::size_t i, std::uint32_t id) {
    const V base = v(s.base_x[i], s.base_y[i], s.base_z[i]);
    const V apex = v(s.apex_x[i], s.apex_y[i], s.apex_z[i]);
    const Real r0 = std::fabs(s.base_radius[i]), r1 = std::fabs(s.apex_radius[i]);
    const Real height = length(apex - base), slope = (r1 - r0) / height;
    const V axis = unit(apex - base), to = org_ - base;
    // |across|^2 = (r0 + slope along)^2 with along and across linear in t
    const Real a0 = dot(to, axis), a1 = dot(dir_, axis);
    const V c0 = to - a0 * axis, c1 = dir_ - a1 * axis;
    const Real r = r0 + slope * a0, rs = slope * a1;
    const Real a = dot(c1, c1) - rs * rs, b = dot(c0, c1) - r * rs, c = dot(c0, c0) - r * r;
    const Real root = b * b - a * c;
    if (std::fabs(a) < 1e-4L || std::fabs(root) < 1e-6L)
      found_.is_clear = false;
    if (root <= 0)
      return;
    for (const Real sign : {-1.L, 1.L}) {
      const Real t = (-b + sign * std::sqrt(root)) / a, along = a0 + t * a1;
      if (std::fabs(along) < 1e-4L || std::fabs(along - height) < 1e-4L)
        found_.is_clear = false;
      const V across = c0 + t * c1;
      const bool outwards = dot(across, c1) - (r + rs * t) * rs > 0;
      if (along > 0 && along < height && (s.base_radius[i] + s.apex_radius[i] >= 0 || outwards))
        add(t, id);
    }
  }

  V org_, dir_;
  Real t_min_, t_max_;
  Crossings found_;
};

// ---- distances ----

inline Real to_segment(const V& p, const V& a, const V& b) {
  const V along = b - a;
  const Real length_squared = dot(along, along);
  const Real share = length_squared > 0 ? dot(p - a, along) / length_squared : 0;
  return length(p - (a + std::clamp(share, 0.L, 1.L) * along));
}
inline Real to_triangle(const V& p, const Corners& c) {
  const V n = cross(c.b - c.a, c.c - c.a);
  const auto side = [&](const V& a, const V& b) { return dot(cross(b - a, p - a), n); };
  if (side(c.a, c.b) >= 0 && side(c.b, c.c) >= 0 && side(c.c, c.a) >= 0)
    return std::fabs(dot(p - c.a, n)) / length(n);
  return std::min(to_segment(p, c.a, c.b),
                  std::min(to_segment(p, c.b, c.c), to_segment(p, c.c, c.a)));
}

/// Cosines and sines of 2,000 angles.
inline const std::vector<std::pair<Real, Real>> kCircle = [] {
  std::vector<std::pair<Real, Real>> circle(2000);
  for (std::size_t k = 0; k < circle.size(); ++k) {
    const Real angle = static_cast<Real>(k) * (3.14159265358979323846L / 1000);
    circle[k] = {std::cos(angle), std::sin(angle)};
  }
  return circle;
}();

/// Distances from a point to every primitive, by id. A cone is 2,000 lines on its side.
inline std::vector<Real> distances(const Scene& s, const Float3& point) {
  const Geometry& g = s.geometry;
  const V p = v(point);
  std::vector<Real> all;
  for (std::size_t i = 0; i < g.planes.size(); ++i) {
    const V n = v(g.planes.nx[i], g.planes.ny[i], g.planes.nz[i]);
    all.push_back(std::fabs(dot(p - v(g.planes.x[i], g.planes.y[i], g.planes.z[i]), n)) /
                  length(n));
  }
  for (std::size_t i = 0; i < g.spheres.size(); ++i)
    all.push_back(std::fabs(length(p - v(g.spheres.x[i], g.spheres.y[i], g.spheres.z[i])) -
                            std::fabs(g.spheres.radius[i])));
  for (std::size_t i = 0; i < g.triangles.size(); ++i)
    all.push_back(to_triangle(p, Corners(g.triangles, i)));
  for (std::size_t i = 0; i < g.cones.size(); ++i) {
    const Cones& c = g.cones;
    const V base = v(c.base_x[i], c.base_y[i], c.base_z[i]);
    const V apex = v(c.apex_x[i], c.apex_y[i], c.apex_z[i]);
    const V axis = unit(apex - base);
    const V x = unit(cross(axis, std::fabs(axis.x) < .5L ? V{1, 0, 0} : V{0, 1, 0}));
    const V y = cross(axis, x);
    Real least = length(p - base) + 1e9L;
    for (const auto& [cosine, sine] : kCircle) {
      const V out = cosine * x + sine * y;
      least = std::min(least,
                       to_segment(p,
                                  base + std::fabs(c.base_radius[i]) * out,
                                  apex + std::fabs(c.apex_radius[i]) * out));
    }
    all.push_back(least);
  }
  return all;
}

}  // namespace grelha::test::brute
