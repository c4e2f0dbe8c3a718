#pragma once
// Surfaces of triangles at hits: points, normals and the mix of the vertices' normals.

#include "kernel/shapes/surface_position.hpp"
#include "kernel/shapes/triangle.hpp"

namespace grelha::GRELHA_ISA {

/// The part of a triangle's surface that is computed in double, and rounded once.
template <class Real>
struct TrianglePosition {
  Vec3<Real> point, normal, weights;
};

/// Replaces the weights of lanes in which doubles cancel by exact ones.
template <class Real>
[[gnu::noinline, gnu::cold]] void settle_weights(const Vec3<Real>& org,
                                                 const Vec3<Real>& dir,
                                                 const TriangleVertices<Real>& c,
                                                 unsigned lanes,
                                                 Vec3<Real>& weight) {
  constexpr int kNumbers = 18;
  const Vec3<Real>* const all[] = {&org, &dir, &c.a, &c.b, &c.c, &weight};
  double number[kNumbers][kWidth<Real>];
  for (int i = 0; i < kNumbers; i += 3) {
    store(number[i], all[i / 3]->x);
    store(number[i + 1], all[i / 3]->y);
    store(number[i + 2], all[i / 3]->z);
  }
  each_bit(lanes, [&](int k) {
    const auto at = [&](int i) { return number[i][k]; };
    const ExactRay ray{{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, 0, 0};
    float corner[3][3];
    for (int i = 0; i < 9; ++i)
      corner[i / 3][i % 3] = static_cast<float>(at(6 + i));
    double found[3];
    crossing_weights(ray, corner, found);
    const double sum = (found[0] + found[1]) + found[2];
    for (int i = 0; sum < 2 && i < 3; ++i)
      number[15 + i][k] = found[i] / sum;
  });
  weight = {load<Real>(number[15]), load<Real>(number[16]), load<Real>(number[17])};
}

/// Corners as they are, not permuted; `axis` is that of largest_axis().
template <class Real>
inline TrianglePosition<Real> triangle_position(const Real& axis,
                                                const Vec3<Real>& org,
                                                const Vec3<Real>& dir,
                                                const TriangleVertices<Real>& c) {
  const auto turned = [&](const Vec3<Real>& p) { return permute_axes<Real>(axis, p); };
  auto [w, sure] =
      weights_at<Real>(turned(org), turned(dir), {turned(c.a), turned(c.b), turned(c.c)});
  constexpr unsigned kAll = (1u << kWidth<Real>)-1;
  if (const unsigned unsure = ~bits(sure) & kAll; unsure != 0) [[unlikely]]
    settle_weights(org, dir, c, unsure, w);
  const Vec3<Real> e1 = c.b - c.a;
  const Vec3<Real> e2 = c.c - c.a;
  return {
      c.a + (w.y * e1 + w.z * e2),
      normalize(cross(e1, e2)),
      w,
  };
}

template <class Real, int i = 0>
inline void triangle_positions(const Real& axis,
                               const Vec3<Real>& org,
                               const Vec3<Real>& dir,
                               const TriangleVertices<Real>& c,
                               PositionParts<Real>& to) {
  const TrianglePosition<Wide<Real>> p = triangle_position<Wide<Real>>(
      to_double<i>(axis), to_double<i>(org), to_double<i>(dir), to_double<i>(c));
  int k = 0;
  for (const Vec3<Wide<Real>>* v : {&p.point, &p.normal, &p.weights})
    for (const Wide<Real>* x : {&v->x, &v->y, &v->z})
      to.part[k++][i] = *x;
  if constexpr (i + 1 < kWideParts<Real>)
    triangle_positions<Real, i + 1>(axis, org, dir, c, to);
}

/// Square of the length of mixed unit normals below which they cancel: rounding decides where such
/// a mix points to.
inline constexpr float kLeastMix = 1e-12f;

/// The axes that prepare() gave the rays.
template <class Real>
inline Real shear_axes(const Vec3<Real>& dir) {
  const Real x = magnitude(dir.x);
  const Real y = magnitude(dir.y);
  const Real z = magnitude(dir.z);
  return select(mask_and(x >= y, x >= z), Real(0), select(y >= z, Real(1), Real(2)));
}

/// The normals of three vertices, mixed by weights, on the side of `flat`; where a vertex has none,
/// or they cancel, `flat`.
template <class Real>
inline Vec3<Real> mixed_normal(const Triangle::Arrays& triangles,
                               const Words<Real> (&vertex)[3],
                               const Vec3<Real>& weights,
                               const Vec3<Real>& flat) {
  const Real o(0), one(1);
  Mask<Real> sound = one > o;
  const auto normal = [&](const Words<Real>& i) {
    const Vec3<Real> m = three_at(triangles.normal, i);
    const Real mm = dot(m, m);
    sound = mask_and(sound, mm > o);
    return (one / square_root(mm)) * m;
  };
  const Vec3<Real> a = normal(vertex[0]);
  const Vec3<Real> b = normal(vertex[1]);
  const Vec3<Real> c = normal(vertex[2]);
  const Vec3<Real> mix = weights.x * a + (weights.y * b + weights.z * c);
  const Real mm = dot(mix, mix);
  const Vec3<Real> m = (one / square_root(mm)) * mix;
  const Vec3<Real> same_side = select(dot(m, flat) < o, Vec3<Real>{o, o, o} - m, m);
  return select(mask_and(sound, mm > Real(kLeastMix)), same_side, flat);
}

/// The colours of three vertices, mixed by weights.
template <class Real>
inline Vec3<Real> mixed_color(const Triangle::Arrays& triangles,
                              const Words<Real> (&vertex)[3],
                              const Vec3<Real>& weights) {
  return weights.x * three_at(triangles.color, vertex[0]) +
         (weights.y * three_at(triangles.color, vertex[1]) +
          weights.z * three_at(triangles.color, vertex[2]));
}

/// Surfaces of triangles i at the rays' hits.
template <class Real>
inline Surface<Real> surface_on(const Triangle::Arrays& triangles,
                                const Words<Real>& i,
                                const SurfaceHit<Real>& met) {
  const Words<Real> v[3] = {words_at(triangles.corner[0], i),
                            words_at(triangles.corner[1], i),
                            words_at(triangles.corner[2], i)};
  const TriangleVertices<Real> c = {three_at(triangles.vertex, v[0]),
                                    three_at(triangles.vertex, v[1]),
                                    three_at(triangles.vertex, v[2])};
  PositionParts<Real> place;
  triangle_positions<Real>(shear_axes(met.dir), met.org, met.dir, c, place);
  const Vec3<Real> point = place.vector(0);
  const Vec3<Real> n = place.vector(3);
  const Vec3<Real> weights = place.vector(6);
  const Real max_coordinate = max(max(largest(c.a), largest(c.b)), largest(c.c));
  Surface<Real> s{
      .point = point,
      .normal = n,
      .shading = n,
      .offset = Real(4 * kEps) * largest(point) + Real(kWideEps) * max_coordinate,
      .material = words_at(triangles.material, i),
  };
  if (met.smooth)
    s.shading = mixed_normal<Real>(triangles, v, weights, n);
  if (met.color)
    *met.color = mixed_color<Real>(triangles, v, weights);
  return s;
}

}  // namespace grelha::GRELHA_ISA
