#pragma once
// Intersects a ray with a primitive in long double (64 bits of mantissa), from the definition of
// the primitive alone: no formula is shared with the kernel. Distances to a surface judge an answer
// better than differences of t, which grow without bound for grazing rays although the hit point
// stays as accurate.

#include <algorithm>
#include <cmath>
#include <optional>

#include "grelha/geometry.hpp"

namespace grelha::test::oracle {

using Real = long double;
inline constexpr Real kEps = 0x1p-24L;  ///< half an ulp of 1 in float: one rounding

struct V {
  Real x, y, z;
  V(Real a, Real b, Real c) : x(a), y(b), z(c) {}
  V(const Float3& f) : x(f.x), y(f.y), z(f.z) {}
};
inline V operator+(const V& a, const V& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline V operator-(const V& a, const V& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline V operator*(Real s, const V& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline Real dot(const V& a, const V& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline V cross(const V& a, const V& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Real length(const V& a) {
  return std::sqrt(dot(a, a));
}
inline V unit(const V& a) {
  return (1 / length(a)) * a;
}

struct Ray {
  V org, dir;
  V point(Real t) const { return org + t * dir; }
};

/// A crossing: where, and the cosine between ray and normal (1: head on, 0: grazing).
struct Crossing {
  Real t, cosine;
};

// ---- sphere ----

struct Ball {
  V center;
  Real radius;
  Real distance(const V& p) const { return std::abs(length(p - center) - std::abs(radius)); }
  /// First crossing beyond t_min, from outside or inside. Geometry: the foot of the perpendicular
  /// and Pythagoras.
  std::optional<Crossing> first(const Ray& ray, Real t_min) const {
    const Real scale = length(ray.dir), foot = dot(center - ray.org, ray.dir) / (scale * scale);
    const Real miss = length(cross(ray.dir, center - ray.org)) / scale, r = std::abs(radius);
    if (miss > r)
      return {};
    const Real half = std::sqrt((r - miss) * (r + miss));
    for (const Real t : {foot - half / scale, foot + half / scale})
      if (t > t_min && (radius > 0 || t > foot))
        return Crossing{t, half / r};
    return {};
  }
};

// ---- plane ----

struct Sheet {
  V point, normal;
  Real distance(const V& p) const { return std::abs(dot(p - point, unit(normal))); }
  std::optional<Crossing> first(const Ray& ray, Real t_min) const {
    const Real along = dot(ray.dir, normal);
    if (along == 0)
      return {};
    const Real t = dot(point - ray.org, normal) / along;
    if (!(t > t_min))
      return {};
    return Crossing{t, std::abs(along) / (length(ray.dir) * length(normal))};
  }
};

// ---- cone ----

/// The side of a frustum. Its profile in (height, radius) is a segment from (0, r0) to (h, r1).
struct Frustum {
  V base, apex;
  Real r0, r1;  ///< both negative: only the inside shows
  Real height() const { return length(apex - base); }
  V axis() const { return unit(apex - base); }
  Real distance(const V& p) const {
    const V d = p - base;
    const Real z = dot(d, axis()), rho = length(cross(axis(), d)), h = height(), a = std::abs(r0),
               b = std::abs(r1);
    const Real s =
        std::clamp((z * h + (rho - a) * (b - a)) / (h * h + (b - a) * (b - a)), Real(0), Real(1));
    return std::hypot(z - s * h, rho - (a + s * (b - a)));
  }
  /// Height and outward normal at a point of the side.
  Real height_at(const V& p) const { return dot(p - base, axis()); }
  V normal_at(const V& p) const {
    const Real slope = (std::abs(r1) - std::abs(r0)) / height();
    const V out = (p - base) - height_at(p) * axis();
    return unit(unit(out) - slope * axis());
  }
  std::optional<Crossing> first(const Ray& ray, Real t_min) const {
    const Real h = height(), a0 = std::abs(r0), slope = (std::abs(r1) - a0) / h;
    const V n = axis();
    // The quadratic about the ray's point nearest to the base: far origins would cancel.
    const Real near = dot(base - ray.org, ray.dir) / dot(ray.dir, ray.dir);
    const V p = ray.point(near) - base;
    const Real pz = dot(p, n), dz = dot(ray.dir, n);
    const V pr = p - pz * n, dr = ray.dir - dz * n;
    const Real a = dot(dr, dr) - slope * slope * dz * dz;
    const Real b = dot(pr, dr) - slope * dz * (a0 + slope * pz);
    const Real c = dot(pr, pr) - (a0 + slope * pz) * (a0 + slope * pz);
    Real roots[2];
    int count = 0;
    if (const Real disc = b * b - a * c; a == 0) {
      if (b != 0)
        roots[count++] = -c / (2 * b);
    } else if (disc >= 0) {
      const Real q = -(b + (b < 0 ? -std::sqrt(disc) : std::sqrt(disc)));
      roots[count++] = q / a;
      if (q != 0)
        roots[count++] = c / q;
    }
    if (count == 2 && roots[0] > roots[1])
      std::swap(roots[0], roots[1]);
    for (int i = 0; i < count; ++i) {
      const Real z = pz + roots[i] * dz, t = near + roots[i];
      if (!(t > t_min) || z < 0 || z > h || a0 + slope * z < 0)
        continue;
      const Real towards = dot(normal_at(ray.point(t)), ray.dir) / length(ray.dir);
      if (r0 + r1 < 0 && towards < 0)
        continue;
      return Crossing{t, std::abs(towards)};
    }
    return {};
  }
};

// ---- triangle ----

struct Facet {
  V a, b, c;
  V normal() const { return cross(b - a, c - a); }
  static Real to_segment(const V& p, const V& a, const V& b) {
    const V ab = b - a;
    const Real l = dot(ab, ab),
               s = l > 0 ? std::clamp(dot(p - a, ab) / l, Real(0), Real(1)) : Real(0);
    return length(p - (a + s * ab));
  }
  Real to_edges(const V& p) const {
    return std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
  }
  /// Whether p, moved into the plane, lies within the triangle.
  bool covers(const V& p) const {
    const V n = normal();
    const Real u = dot(cross(b - a, p - a), n), v = dot(cross(c - b, p - b), n),
               w = dot(cross(a - c, p - c), n);
    return u >= 0 && v >= 0 && w >= 0;
  }
  Real distance(const V& p) const {
    if (const V n = normal(); dot(n, n) > 0 && covers(p))
      return std::abs(dot(p - a, unit(n)));
    return to_edges(p);
  }
  std::optional<Crossing> first(const Ray& ray, Real t_min) const {
    const V n = normal();
    const Real along = dot(ray.dir, n);
    if (along == 0)
      return {};
    const Real t = dot(a - ray.org, n) / along;
    if (!(t > t_min) || !covers(ray.point(t)))
      return {};
    return Crossing{t, std::abs(along) / (length(n) * length(ray.dir))};
  }
  /// How far the ray's line passes inside (positive) or outside (negative) the outline, seen along
  /// the ray.
  Real clearance(const Ray& ray) const {
    const V d = unit(ray.dir);
    const auto flat = [&](const V& p) { return (p - ray.org) - dot(p - ray.org, d) * d; };
    const Facet seen{flat(a), flat(b), flat(c)};
    const V o{0, 0, 0};
    const Real u = dot(cross(seen.b - seen.a, o - seen.a), d),
               v = dot(cross(seen.c - seen.b, o - seen.b), d),
               w = dot(cross(seen.a - seen.c, o - seen.c), d);
    const bool within = (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
    return within ? seen.to_edges(o) : -seen.to_edges(o);
  }
};

}  // namespace grelha::test::oracle
