#pragma once
// The point of a primitive that is nearest to a given one, in double.

#include <type_traits>

#include "kernel/shapes/shapes.hpp"

namespace grelha::GRELHA_ISA {

using Point = Vec3<double>;

inline Point point_of(const float (&v)[3]) {
  return {v[0], v[1], v[2]};
}

template <class Vector>
using NumberOf = std::remove_cvref_t<decltype(Vector::x)>;

[[gnu::always_inline]] inline WideVector select(bool m, const WideVector& a, const WideVector& b) {
  return m ? a : b;
}

/// Of a segment.
template <class Vector>
[[gnu::always_inline]] inline Vector nearest_on_segment(const Vector& p,
                                                        const Vector& a,
                                                        const Vector& b) {
  const Vector along = b - a;
  const auto squared = dot(along, along);
  const auto product = dot(p - a, along);
  const NumberOf<Vector> share = product / squared;
  const Vector before_b = select(product < squared, a + share * along, b);
  return select(product > NumberOf<Vector>(0), before_b, a);
}

/// Of the region that the vertices of a triangle belong to (Ericson, Real-Time Collision Detection,
/// 2005, 5.1.5): a vertex, an edge or the face; n is (b - a) x (c - a). Of one, or of many side by
/// side: the same bits.
template <class Vector>
[[gnu::always_inline]] inline Vector nearest_on_triangle(
    const Vector& p, const Vector& a, const Vector& b, const Vector& c, const Vector& n) {
  const NumberOf<Vector> nn = dot(n, n);
  const auto outside = [&](const Vector& from, const Vector& to) {
    return dot(cross(to - from, p - from), n) < NumberOf<Vector>(0);
  };
  const auto beside = mask_or(mask_or(outside(a, b), outside(b, c)), outside(c, a));
  Vector way = p - a;  // from the nearest corner: the product is off by as much less
  const auto shorten = [&](const Vector& from) {
    way = select(dot(from, from) < dot(way, way), from, way);
  };
  shorten(p - b);
  shorten(p - c);
  const NumberOf<Vector> share = dot(way, n) / nn;
  Vector best = nearest_on_segment(p, a, b);
  const auto compare = [&](const Vector& at) {
    best = select(dot(at - p, at - p) < dot(best - p, best - p), at, best);
  };
  compare(nearest_on_segment(p, b, c));
  compare(nearest_on_segment(p, c, a));
  return select(and_not(nn > NumberOf<Vector>(0), beside), p - share * n, best);
}

/// Squared, of what the area of a triangle is of the product of two edges: doubles lose the normal
/// of thinner ones, so numbers of 106 bits find their points.
inline constexpr double kThin = 0x1p-12;

/// True of triangles whose normal doubles lose.
template <class Vector>
[[gnu::always_inline]] inline auto is_thin(const Vector& to_b,
                                           const Vector& to_c,
                                           const Vector& n) {
  return dot(n, n) < NumberOf<Vector>(kThin) * (dot(to_b, to_b) * dot(to_c, to_c));
}

inline Point nearest_on(const Point& p, const Triangle::Fields<float>& triangle) {
  const Point a = point_of(triangle.corner[0]);
  const Point b = point_of(triangle.corner[1]);
  const Point c = point_of(triangle.corner[2]);
  const Point n = cross(b - a, c - a);
  if (!is_thin(b - a, c - a, n))
    return nearest_on_triangle(p, a, b, c, n);
  const auto wide = [](const Point& v) { return WideVector{v.x, v.y, v.z}; };
  const WideVector found = nearest_on_triangle(
      wide(p), wide(a), wide(b), wide(c), cross(wide(b) - wide(a), wide(c) - wide(a)));
  return {found.x.high, found.y.high, found.z.high};
}

inline Point nearest_on(const Point& p, const Sphere::Fields<float>& sphere) {
  const Point center = point_of(sphere.center);
  const double radius = magnitude(static_cast<double>(sphere.radius));
  const Point way = p - center;
  const double distance = length(way);
  return distance > 0 ? center + (radius / distance) * way : center + Point{radius, 0, 0};
}

inline Point nearest_on(const Point& p, const Plane::Fields<float>& plane) {
  const Point n = point_of(plane.normal);
  return p - (dot(p - point_of(plane.point), n) / dot(n, n)) * n;
}

/// Of the side of a cone frustum: of the line on it that lies in a plane with its axis and p.
inline Point nearest_on(const Point& p, const Cone::Fields<float>& cone) {
  const Point base = point_of(cone.base);
  const Point axis = normalize(point_of(cone.axis));
  const double along = dot(p - base, axis);
  Point out = (p - base) - along * axis;
  if (!(dot(out, out) > 0)) {  // any direction across the axis
    const Point x{1, 0, 0}, y{0, 1, 0};
    out = cross(axis, magnitude(axis.x) < .5 ? x : y);
  }
  const Point across = normalize(out);
  const double height = cone.height;
  const double narrow = cone.radius;
  const double wide = narrow + static_cast<double>(cone.slope) * height;
  return nearest_on_segment(p, base + narrow * across, (base + height * axis) + wide * across);
}

// ---- unit normals at points of surfaces, outwards ----

inline Point normal_at(const Point&, const Triangle::Fields<float>& triangle) {
  const Point a = point_of(triangle.corner[0]);
  return normalize(cross(point_of(triangle.corner[1]) - a, point_of(triangle.corner[2]) - a));
}
inline Point normal_at(const Point& p, const Sphere::Fields<float>& sphere) {
  return normalize(p - point_of(sphere.center));
}
inline Point normal_at(const Point&, const Plane::Fields<float>& plane) {
  return normalize(point_of(plane.normal));
}
inline Point normal_at(const Point& p, const Cone::Fields<float>& cone) {
  const Point axis = normalize(point_of(cone.axis));
  const Point from_base = p - point_of(cone.base);
  const Point across = normalize(from_base - dot(from_base, axis) * axis);
  return normalize(across - static_cast<double>(cone.slope) * axis);
}

}  // namespace grelha::GRELHA_ISA
