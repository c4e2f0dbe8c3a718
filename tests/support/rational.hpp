#pragma once
// Intersects a ray with triangles and planes in rational numbers (GMP): nothing is rounded, and no
// formula or filter is shared with the kernel. Candidates that long double certainly excludes are
// skipped.

#include <gmpxx.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "grelha/geometry.hpp"
#include "grelha/rays.hpp"
#include "tests/support/triangle_tree.hpp"

namespace grelha::test::rational {

struct Vector {
  mpq_class x, y, z;
  Vector(mpq_class a, mpq_class b, mpq_class c)
      : x(std::move(a)), y(std::move(b)), z(std::move(c)) {}
  Vector(const Float3& f) : x(f.x), y(f.y), z(f.z) {}
};
inline Vector operator-(const Vector& a, const Vector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline mpq_class dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// t of the point where a line meets the plane of a triangle, if that lies within it, edges and
/// corners included: the point is on the inner side of each edge. None where the line is parallel.
inline std::optional<mpq_class> crossing(
    const Vector& org, const Vector& dir, const Vector& a, const Vector& b, const Vector& c) {
  const Vector p[3] = {a, b, c};
  const Vector n = cross(p[1] - p[0], p[2] - p[0]);
  const mpq_class along = dot(n, dir);
  if (along == 0)
    return {};
  const mpq_class t = dot(n, p[0] - org) / along;
  const Vector at(org.x + t * dir.x, org.y + t * dir.y, org.z + t * dir.z);
  for (int k = 0; k < 3; ++k)
    if (dot(cross(p[(k + 1) % 3] - p[k], at - p[k]), n) < 0)
      return {};
  return t;
}
inline std::optional<mpq_class> crossing(const Ray& ray,
                                         const Float3& a,
                                         const Float3& b,
                                         const Float3& c) {
  return crossing(Vector(ray.org), Vector(ray.dir), Vector(a), Vector(b), Vector(c));
}

/// Returns true if long double shows that a line misses a triangle.
inline bool passes_by(const Ray& ray, const Float3& a, const Float3& b, const Float3& c) {
  using L = long double;
  L p[3][3];
  const Float3* corner[3] = {&a, &b, &c};
  L size = 0;
  for (int k = 0; k < 3; ++k) {
    p[k][0] = L{corner[k]->x} - ray.org.x;
    p[k][1] = L{corner[k]->y} - ray.org.y;
    p[k][2] = L{corner[k]->z} - ray.org.z;
    for (const L x : p[k])
      size = std::max(size, std::abs(x));
  }
  const L d[3] = {ray.dir.x, ray.dir.y, ray.dir.z};
  const L error_bound =
      1e-15L * size * size * std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])});
  bool below = false;
  bool above = false;
  for (int k = 0; k < 3; ++k) {
    const L* const u = p[k];
    const L* const v = p[(k + 1) % 3];
    const L side = d[0] * (u[1] * v[2] - u[2] * v[1]) + d[1] * (u[2] * v[0] - u[0] * v[2]) +
                   d[2] * (u[0] * v[1] - u[1] * v[0]);
    below |= side < -error_bound;
    above |= side > error_bound;
  }
  return below && above;
}

/// The float nearest to a number; of two the one with the even last bit.
inline float nearest(const mpq_class& t) {
  auto f = static_cast<float>(t.get_d());
  for (const float g : {std::nextafter(f, -std::numeric_limits<float>::infinity()),
                        std::nextafter(f, std::numeric_limits<float>::infinity())}) {
    const mpq_class here = abs(mpq_class(f) - t);
    const mpq_class there = abs(mpq_class(g) - t);
    if (there < here || (there == here && std::bit_cast<std::uint32_t>(g) % 2 == 0))
      f = g;
  }
  return f;
}

/// The nearest hit of a ray among a scene's triangles; at equal t the lower id.
struct First {
  std::uint32_t id = kNoPrimitive;
  float t = 0;  ///< rounded once
};

/// Intersects rays with all triangles of a scene. Long double leaves out boxes that lines pass by.
class FirstTriangle {
 public:
  explicit FirstTriangle(const Scene& scene)
      : all_(scene.geometry.triangles), tree_(scene.geometry.triangles) {}

  First operator()(const Ray& ray) const {
    First first;
    std::optional<mpq_class> least;
    visit(ray, [&](std::uint32_t i, const mpq_class& t) {
      if (least && (t > *least || (t == *least && i > first.id)))
        return;
      least = t;
      first.id = i;
    });
    if (least)
      first.t = nearest(*least);
    return first;
  }

  /// The hits of a ray in order of t, those of equal t in order of id.
  std::vector<std::pair<mpq_class, std::uint32_t>> all(const Ray& ray) const {
    std::vector<std::pair<mpq_class, std::uint32_t>> hits;
    visit(ray, [&](std::uint32_t i, const mpq_class& t) { hits.emplace_back(t, i); });
    std::sort(hits.begin(), hits.end());
    return hits;
  }

 private:
  Float3 corner(std::uint32_t v) const { return {all_.x[v], all_.y[v], all_.z[v]}; }

  static bool passes_by(const TriangleTree::Bounds& n, const Ray& ray) {
    using L = long double;
    const L o[3] = {ray.org.x, ray.org.y, ray.org.z};
    const L d[3] = {ray.dir.x, ray.dir.y, ray.dir.z};
    L t0 = -1e300L;
    L t1 = 1e300L;
    for (int a = 0; a < 3; ++a) {
      const L error_bound = 1e-15L * (std::abs(o[a]) + std::abs(n.lo[a]) + std::abs(n.hi[a]));
      const L x = n.lo[a] - o[a] - error_bound;
      const L y = n.hi[a] - o[a] + error_bound;
      if (d[a] == 0 && (x > 0 || y < 0))
        return true;
      if (d[a] == 0)
        continue;
      t0 = std::max(t0, std::min(x / d[a], y / d[a]));
      t1 = std::min(t1, std::max(x / d[a], y / d[a]));
    }
    const L slack = 1e-15L * (std::abs(t0) + std::abs(t1));
    return t0 > t1 + slack;
  }

  /// Calls found(i, t) for each triangle that a ray hits.
  template <class Found>
  void visit(const Ray& ray, const Found& found) const {
    tree_.visit([&](const TriangleTree::Bounds& box) { return passes_by(box, ray); },
                [](const TriangleTree::Bounds&) { return 0; },
                [&](std::uint32_t i) {
                  const Float3 a = corner(all_.a[i]);
                  const Float3 b = corner(all_.b[i]);
                  const Float3 c = corner(all_.c[i]);
                  if (rational::passes_by(ray, a, b, c))
                    return;
                  const auto t = crossing(ray, a, b, c);
                  if (t && (!std::isfinite(ray.t_min) || *t > ray.t_min) &&
                      (!std::isfinite(ray.t_max) || *t < ray.t_max))
                    found(i, *t);
                });
  }

  const Triangles& all_;
  TriangleTree tree_;
};

}  // namespace grelha::test::rational
