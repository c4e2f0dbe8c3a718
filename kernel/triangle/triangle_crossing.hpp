#pragma once
// Where rays cross triangles, computed in double: what floats leave open, and what is shaded.

#include "kernel/simd/vec3.hpp"

namespace grelha::GRELHA_ISA {

/// a b - c d with the right sign, and its size to within 2^-50 even where the products nearly
/// agree: a product and what rounding took from it, Dekker, "A Floating-Point Technique for
/// Extending the Available Precision", 1971.
inline double difference_of_products(double a, double b, double c, double d) {
  const auto rest = [](double x, double y, double xy) {
    const double p = 134217729. * x, q = 134217729. * y;
    const double x1 = p - (p - x), x2 = x - x1, y1 = q - (q - y), y2 = y - y1;
    return ((x1 * y1 - xy) + x1 * y2 + x2 * y1) + x2 * y2;
  };
  const double ab = a * b, cd = c * d;
  return (ab - cd) + (rest(a, b, ab) - rest(c, d, cd));
}

/// Corners of a triangle, in its ray's permuted axes.
template <class Real>
struct Corners {
  Vec3<Real> a, b, c;
};

/// A ray and a triangle that it may cross, in the ray's permuted axes, lane by lane or broadcast.
template <class Real>
struct RayAndTriangle {
  Vec3<Real> org, dir;
  Corners<Real> corner;
};

/// Where a ray crosses a triangle, computed in double.
template <class Real>
struct Crossing {
  Mask<Real> inside;  ///< the ray crosses, edges and corners included
  Real t;
  Vec3<Real> weights;  ///< of the corners: not negative, 1 together
};

/// Edge functions of corners that lie as (ax, ay), (bx, by), (cx, cy) around their ray, where one
/// of them came out as zero.
template <class Real>
[[gnu::noinline, gnu::cold]] void exact_edges(const Mask<Real>& chosen,
                                              const Real (&corner)[6],
                                              Vec3<Real>& edge) {
  constexpr int n = kWidth<Real>;
  double p[6][n];
  double e[3][n];
  for (int i = 0; i < 6; ++i)
    store(p[i], corner[i]);
  store(e[0], edge.x);
  store(e[1], edge.y);
  store(e[2], edge.z);
  for (unsigned lanes = bits(chosen); lanes != 0; lanes &= lanes - 1) {
    const int i = __builtin_ctz(lanes);
    e[0][i] = difference_of_products(p[4][i], p[3][i], p[5][i], p[2][i]);
    e[1][i] = difference_of_products(p[0][i], p[5][i], p[1][i], p[4][i]);
    e[2][i] = difference_of_products(p[2][i], p[1][i], p[3][i], p[0][i]);
  }
  load(e[0], edge.x);
  load(e[1], edge.y);
  load(e[2], edge.z);
}

/// Real: double or DoubleLanes. Corners are sheared by a function of ray and corner alone, and the
/// sign of each edge function of what comes out is exact: triangles that share an edge or a corner
/// agree about it, so no ray passes between them.
template <class Real>
[[gnu::always_inline]] inline Crossing<Real> crossing(const Vec3<Real>& org,
                                                      const Vec3<Real>& dir,
                                                      const Corners<Real>& corner) {
  const Real o(0);
  const Vec3<Real> oa = corner.a - org, ob = corner.b - org, oc = corner.c - org;
  const Real ax = oa.x * dir.z - dir.x * oa.z, ay = oa.y * dir.z - dir.y * oa.z;
  const Real bx = ob.x * dir.z - dir.x * ob.z, by = ob.y * dir.z - dir.y * ob.z;
  const Real cx = oc.x * dir.z - dir.x * oc.z, cy = oc.y * dir.z - dir.y * oc.z;
  Vec3<Real> edge{cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax};
  const Mask<Real> zero = either(either(edge.x == o, edge.y == o), edge.z == o);
  if (any(zero))
    exact_edges<Real>(zero, {ax, ay, bx, by, cx, cy}, edge);
  const Real least = lesser(lesser(edge.x, edge.y), edge.z),
             most = greater(greater(edge.x, edge.y), edge.z);
  const Real sum = (edge.x + edge.y) + edge.z;
  Crossing<Real> r;
  r.inside = both(either(least >= o, most <= o), sum != o);
  r.weights = (Real(1) / sum) * edge;
  r.t = ((r.weights.x * oa.z + r.weights.y * ob.z) + r.weights.z * oc.z) / dir.z;
  return r;
}

/// Part i of the lanes of corners, in double.
template <int i, class Real>
inline Corners<Wide<Real>> widen(const Corners<Real>& c) {
  return {widen<i>(c.a), widen<i>(c.b), widen<i>(c.c)};
}

/// t of chosen lanes by crossing(), NaN where the ray does not cross; part after part, of those
/// with a chosen lane.
template <int i, class Real>
[[gnu::always_inline]] inline void part_in_double(const RayAndTriangle<Real>& from,
                                                  unsigned chosen,
                                                  Wide<Real> (&t)[kWideParts<Real>]) {
  constexpr int n = kWidth<Wide<Real>>;
  if (chosen >> (i * n) & ((1u << n) - 1)) {
    const Crossing<Wide<Real>> r =
        crossing<Wide<Real>>(widen<i>(from.org), widen<i>(from.dir), widen<i>(from.corner));
    t[i] = select(r.inside, r.t, Wide<Real>(__builtin_nan("")));
  }
  if constexpr (i + 1 < kWideParts<Real>)
    part_in_double<i + 1, Real>(from, chosen, t);
}

/// Times the product of sizes: bound of the error of a normal times a vector, 16 u. It is 9 u, as
/// docs/numerics.md derives. Below kLeastProduct floats may have underflowed.
inline constexpr float kProductError = 0x1p-20f;
inline constexpr float kLeastProduct = 0x1p-100f;

/// Rays that are surely past the plane of their triangle at t_min, by its normal. Of the triangle
/// that a ray starts on it tells more than the edges do: their error grows with the distance to the
/// corners.
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
    return both(magnitude(product) > error, magnitude(product) > least);
  };
  const Mask<Real> apart =
      either(both(left<Real(0), ahead> Real(0)), both(left > Real(0), ahead < Real(0)));
  return both(apart, both(sure(left, sizes(to) + sizes(way)), sure(ahead, sizes(r.dir))));
}

/// t of chosen lanes by crossing(); NaN where the ray does not cross, or surely not beyond t_min:
/// what is `near` it is asked first. Each lane is told what it would be told alone.
template <class Real, class Source>
[[gnu::noinline]] Real depth_in_double(Source source,
                                       Mask<Real> chosen,
                                       Mask<Real> near,
                                       Real t_min) {
  const RayAndTriangle<Real> from = source();
  if (any(near))
    chosen = but_not(chosen, both(near, past_plane(from, t_min)));
  const Real nowhere(__builtin_nanf(""));
  const unsigned lanes = bits(chosen);
  if (lanes == 0)
    return nowhere;
  Wide<Real> t[kWideParts<Real>];
  for (Wide<Real>& part : t)
    part = Wide<Real>(__builtin_nan(""));
  part_in_double<0, Real>(from, lanes, t);
  return select(chosen, narrow<Real>(t), nowhere);
}

}  // namespace grelha::GRELHA_ISA
