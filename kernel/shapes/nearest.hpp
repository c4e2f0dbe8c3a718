#pragma once
// The point of a primitive that is nearest to a given one, in double.

#include "kernel/shapes/geometry_view.hpp"

namespace grelha::GRELHA_ISA {

using Point = Vec3<double>;

inline Point point_of(const float (&v)[3]) {
  return {v[0], v[1], v[2]};
}

/// Of a segment.
inline Point nearest_on_segment(const Point& p, const Point& a, const Point& b) {
  const Point along = b - a;
  const double squared = dot(along, along);
  const double share = squared > 0 ? dot(p - a, along) / squared : 0;
  return a + max(0., min(1., share)) * along;
}

/// Of the region that the vertices of a triangle belong to (Ericson, Real-Time Collision Detection,
/// 2005, 5.1.5): a vertex, an edge or the face.
inline Point nearest_on(const Point& p, const Triangle::Fields<float>& triangle) {
  const Point a = point_of(triangle.corner[0]);
  const Point b = point_of(triangle.corner[1]);
  const Point c = point_of(triangle.corner[2]);
  const Point n = cross(b - a, c - a);
  const double nn = dot(n, n);
  const auto inside = [&](const Point& from, const Point& to) {
    return dot(cross(to - from, p - from), n) >= 0;
  };
  if (nn > 0 && inside(a, b) && inside(b, c) && inside(c, a))
    return p - (dot(p - a, n) / nn) * n;
  Point best = nearest_on_segment(p, a, b);
  for (const Point& at : {nearest_on_segment(p, b, c), nearest_on_segment(p, c, a)})
    if (dot(at - p, at - p) < dot(best - p, best - p))
      best = at;
  return best;
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
