#pragma once
// Intersects one ray with one primitive in float, in double and in exact numbers.

#include <gtest/gtest.h>

#include <cmath>

#include "grelha/geometry.hpp"
#include "kernel/shapes/hit.hpp"
#include "kernel/shapes/shapes.hpp"

namespace grelha::test {

struct OneHit {
  bool hit;
  float t;  ///< rounded once
};

inline ExactCrossing exact_hit(const ExactRay& ray, const Triangle::Fields<float>& triangle) {
  return cross_triangle(ray, triangle.corner);
}
template <class Fields>
ExactCrossing exact_hit(const ExactRay& ray, const Fields& primitive) {
  return scalar::exact_crossing(ray, primitive);
}

/// Fails where floats or doubles tell what exact numbers do not.
template <class Real>
void expect_bounds(const scalar::HitInterval<Real>& found,
                   const ExactCrossing& exact,
                   float t_max) {
  const bool counts = exact.some() && exact.compare(t_max) < 0;
  EXPECT_TRUE(found.some || !counts) << "lost at t " << (counts ? exact.estimate() : 0);
  if (!found.some || !found.sure)
    return;
  ASSERT_TRUE(exact.some()) << "met at t from " << found.lo << " to " << found.hi;
  EXPECT_GE(exact.compare(found.lo), 0) << exact.estimate() << " against " << found.lo;
  EXPECT_LE(exact.compare(found.hi), 0) << exact.estimate() << " against " << found.hi;
}

/// A ray in float, of any length that is traced as it is.
inline scalar::SimdRays<float> in_float(const ExactRay& r) {
  const scalar::Vec3<float> dir{
      static_cast<float>(r.dir[0]), static_cast<float>(r.dir[1]), static_cast<float>(r.dir[2])};
  const float inv_dd = 1 / dot(dir, dir);
  return {.org = {static_cast<float>(r.org[0]),
                  static_cast<float>(r.org[1]),
                  static_cast<float>(r.org[2])},
          .dir = dir,
          .inv_dd = inv_dd,
          .inv_length = inverse_length(dir, inv_dd),
          .t_min = static_cast<float>(r.t_min),
          .frame_error = 0,
          .error_bound = std::numeric_limits<float>::infinity()};
}

template <class Shape>
OneHit one_hit(const ExactRay& ray,
               const typename Shape::template Fields<float>& primitive,
               float t_max = std::numeric_limits<float>::infinity()) {
  const ExactCrossing exact = exact_hit(ray, primitive);
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if constexpr (Shape::kKind == PrimitiveKind::kTriangle) {
    const auto& d = ray.dir;
    const int k = scalar::largest_axis(
        static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2]));
    const int kx = scalar::kNextAxis[k];
    const int ky = scalar::kPreviousAxis[k];
    const auto turned = [&](const auto& v) {
      return scalar::Vec3<float>{
          static_cast<float>(v[kx]), static_cast<float>(v[ky]), static_cast<float>(v[k])};
    };
    const auto& c = primitive.corner;
    const scalar::RayAndTriangle<float> from{
        turned(ray.org), turned(d), {turned(c[0]), turned(c[1]), turned(c[2])}};
    const scalar::Vec3<float>& dir = from.dir;
    const scalar::Shear<float> shear{dir.x / dir.z, dir.y / dir.z, 1 / dir.z, 0};
    expect_bounds(scalar::bound_triangle<float>(from, shear, static_cast<float>(ray.t_min), t_max),
                  exact,
                  t_max);
    expect_bounds(scalar::bound_triangle(ray, primitive.corner), exact, t_max);
  } else {
    const scalar::HitInterval<float> found = scalar::bound(in_float(ray), primitive, t_max);
    expect_bounds(found, exact, t_max);
    const auto wide = scalar::in_double(ray);
    const auto in_double = scalar::fields_to_double<Shape, 0, float>(primitive);
    expect_bounds(scalar::bound(wide, in_double, kNever), exact, t_max);
    if constexpr (Shape::kKind == PrimitiveKind::kSphere) {
      const auto step = scalar::narrowed<double>(wide, in_double, found.lo, found.hi);
      if (found.some && found.sure && step.sure)
        expect_bounds(step, exact, t_max);
    }
  }
  const bool hit = exact.some() && exact.compare(t_max) < 0;
  return {hit, hit ? exact.rounded() : -1};
}

inline ExactRay exact_ray(const Float3& o, const Float3& d, float t_min = 0) {
  return {{o.x, o.y, o.z}, {d.x, d.y, d.z}, t_min, std::numeric_limits<double>::infinity()};
}

}  // namespace grelha::test
