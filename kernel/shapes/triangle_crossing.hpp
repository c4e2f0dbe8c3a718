#pragma once
// Crossing points of rays and triangles, and rays that are past a triangle's plane.

#include "kernel/shapes/hit.hpp"

namespace grelha::GRELHA_ISA {

/// Corners of a triangle, in its ray's permuted axes.
template <class Real>
struct TriangleVertices {
  Vec3<Real> a, b, c;
};

/// A ray and a triangle that it may cross, in the ray's permuted axes, lane by lane or broadcast.
template <class Real>
struct RayAndTriangle {
  Vec3<Real> org, dir;
  TriangleVertices<Real> corner;
};

/// Barycentric weights of points where rays cross triangles: not negative, 1 together. Weights that
/// rounding makes negative are set to 0.
template <class Real>
struct WeightsAt {
  Vec3<Real> weight;
  Mask<Real> sure;  ///< they are within 2^-20
};

/// By edge functions that are off by 24 u S (S + Z): S the largest coordinate of a corner across
/// the ray, Z the largest along it, both times the direction's largest component.
template <class Real>
[[gnu::always_inline]] inline WeightsAt<Real> weights_at(const Vec3<Real>& org,
                                                         const Vec3<Real>& dir,
                                                         const TriangleVertices<Real>& corner) {
  const Real o(0), one(1);
  const Vec3<Real> oa = corner.a - org, ob = corner.b - org, oc = corner.c - org;
  const Real ax = oa.x * dir.z - dir.x * oa.z, ay = oa.y * dir.z - dir.y * oa.z;
  const Real bx = ob.x * dir.z - dir.x * ob.z, by = ob.y * dir.z - dir.y * ob.z;
  const Real cx = oc.x * dir.z - dir.x * oc.z, cy = oc.y * dir.z - dir.y * oc.z;
  const Vec3<Real> edge{cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax};
  const Real area = (edge.x + edge.y) + edge.z;
  const Vec3<Real> part = (one / area) * edge;
  const Vec3<Real> w{max(part.x, o), max(part.y, o), max(part.z, o)};
  const Real sum = (w.x + w.y) + w.z;
  const Real across = max_abs(max_abs(max_abs(ax, ay), max_abs(bx, by)), max_abs(cx, cy));
  const Real along = max_abs(max_abs(oa.z, ob.z), oc.z) * magnitude(dir.z);
  const Real error = units<Real>(96) * (across * (across + along));
  // NaN: rounding left nothing of the triangle as the ray sees it
  return {select(sum < Real(2), (one / sum) * w, Vec3<Real>{one, o, o}),
          error < Real(0x1p-20f) * magnitude(area)};
}

inline Vec3<double> vec_double(const float (&v)[3]) {
  return {v[0], v[1], v[2]};
}

/// Spans of t where lines meet the planes of triangles, if known.
template <class Real>
struct PlaneSpan {
  Mask<Real> known;
  Real lo, hi;  ///< t
};

/// t of a ray that crosses its triangle, by the normal n = e x f. n (a - org) and n dir are off by
/// 8 u of the same sums over the sizes of all products. Fewer steps than by the edge functions, and
/// wider bounds: for doubles, which have digits to spare.
template <class Real>
[[gnu::always_inline]] inline PlaneSpan<Real> plane_span(const Vec3<Real>& org,
                                                         const Vec3<Real>& dir,
                                                         const TriangleVertices<Real>& corner) {
  const Vec3<Real> e = corner.b - corner.a;
  const Vec3<Real> f = corner.c - corner.a;
  const Vec3<Real> to = corner.a - org;
  const Vec3<Real> first{e.y * f.z, e.z * f.x, e.x * f.y};
  const Vec3<Real> second{e.z * f.y, e.x * f.z, e.y * f.x};
  const Vec3<Real> n = first - second;
  const Vec3<Real> size = sizes(first) + sizes(second);
  const Real along = dot(n, dir);
  const Real inverse = Real(1) / along;
  const Real t = dot(n, to) * inverse;
  const Real along_error = units<Real>(16) * dot(size, sizes(dir));
  const Real slack =
      (units<Real>(16) * dot(size, sizes(to)) + magnitude(t) * along_error) * magnitude(inverse);
  return {magnitude(along) > along_error + along_error, t - slack, t + slack};
}

/// t of the same for one ray, rounded once. Returns false where double does not tell.
inline bool round_plane_t(const ExactRay& ray, const float (&corner)[3][3], float& t) {
  const PlaneSpan<double> span =
      plane_span<double>(vec(ray.org),
                         vec(ray.dir),
                         {vec_double(corner[0]), vec_double(corner[1]), vec_double(corner[2])});
  t = static_cast<float>(span.lo) + 0.f;  // no zero is -0
  return span.known && t == static_cast<float>(span.hi);
}

/// Part i of the lanes of corners, in double.
template <int i, class Real>
inline TriangleVertices<Wide<Real>> to_double(const TriangleVertices<Real>& c) {
  return {to_double<i>(c.a), to_double<i>(c.b), to_double<i>(c.c)};
}

/// A normal times a vector: error <= kProductError * product of sizes, 16 u. It is 9 u, as
/// docs/proofs.md derives. Below kLeastProduct floats may have underflowed.
inline constexpr float kProductError = 0x1p-20f;
inline constexpr float kLeastProduct = 0x1p-100f;

/// Rays that are surely past the plane of their triangle at t_min, by its normal. For the triangle
/// that a ray starts on, this decides more cases than the edges do: their error grows with the
/// distance to the corners.
template <class Real>
[[gnu::always_inline]] inline Mask<Real> past_plane(const RayAndTriangle<Real>& r,
                                                    const Real& t_min) {
  const Vec3<Real> e = r.corner.b - r.corner.a;
  const Vec3<Real> f = r.corner.c - r.corner.a;
  const Vec3<Real> to = r.corner.a - r.org;
  const Vec3<Real> way = t_min * r.dir;
  const Real left = dot(cross(e, f), to - way);
  const Real ahead = dot(cross(e, f), r.dir);
  const Vec3<Real> p = sizes(e);
  const Vec3<Real> q = sizes(f);
  const Real least(kLeastProduct);
  const Vec3<Real> size{(p.y * q.z + p.z * q.y) + least,
                        (p.z * q.x + p.x * q.z) + least,
                        (p.x * q.y + p.y * q.x) + least};
  const auto sure = [&](const Real& product, const Vec3<Real>& of) {
    const Real error = Real(kProductError) * dot(size, of);
    return mask_and(magnitude(product) > error, magnitude(product) > least);
  };
  const Mask<Real> apart =
      mask_or(mask_and(left<Real(0), ahead> Real(0)), mask_and(left > Real(0), ahead < Real(0)));
  return mask_and(apart, mask_and(sure(left, sizes(to) + sizes(way)), sure(ahead, sizes(r.dir))));
}

}  // namespace grelha::GRELHA_ISA
