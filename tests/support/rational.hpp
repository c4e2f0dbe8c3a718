#pragma once
// Where a ray meets triangles and planes, in rational numbers (GMP): nothing is rounded, and no
// formula or filter is the kernel's. What long double surely leaves out is not looked at.

#include <gmpxx.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "grelha/geometry.hpp"
#include "grelha/rays.hpp"

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
inline std::optional<mpq_class> crossing(const Ray& ray,
                                         const Float3& a,
                                         const Float3& b,
                                         const Float3& c) {
  const Vector p[3] = {a, b, c};
  const Vector n = cross(p[1] - p[0], p[2] - p[0]);
  const Vector dir(ray.dir);
  const Vector org(ray.org);
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

/// Whether long double tells that a line passes a triangle by.
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
  const L room = 1e-15L * size * size * std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])});
  bool below = false;
  bool above = false;
  for (int k = 0; k < 3; ++k) {
    const L* const u = p[k];
    const L* const v = p[(k + 1) % 3];
    const L side = d[0] * (u[1] * v[2] - u[2] * v[1]) + d[1] * (u[2] * v[0] - u[0] * v[2]) +
                   d[2] * (u[0] * v[1] - u[1] * v[0]);
    below |= side < -room;
    above |= side > room;
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

/// What a ray meets first of a scene's triangles; of equal t the lower id.
struct First {
  std::uint32_t id = kNoPrimitive;
  float t = 0;  ///< rounded once
};

inline First first_triangle(const Scene& scene, const Ray& ray) {
  const auto& all = scene.geometry.triangles;
  const auto corner = [&](std::uint32_t v) { return Float3{all.x[v], all.y[v], all.z[v]}; };
  First first;
  std::optional<mpq_class> least;
  for (std::uint32_t i = 0; i < all.a.size(); ++i) {
    const Float3 a = corner(all.a[i]);
    const Float3 b = corner(all.b[i]);
    const Float3 c = corner(all.c[i]);
    if (passes_by(ray, a, b, c))
      continue;
    const auto t = crossing(ray, a, b, c);
    if (!t || *t <= ray.t_min || (std::isfinite(ray.t_max) && *t >= ray.t_max) ||
        (least && *t >= *least))
      continue;
    least = t;
    first.id = i;
  }
  if (least)
    first.t = nearest(*least);
  return first;
}

}  // namespace grelha::test::rational
