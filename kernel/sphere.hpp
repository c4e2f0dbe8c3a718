#pragma once

#include "kernel/vec3.hpp"

namespace grelha::GRELHA_ISA {

/// |center - org|^2 - radius^2 of chosen lanes in double, where the squares are as good as exact.
template <class Real>
[[gnu::noinline, gnu::cold]] void exact_power(const Mask<Real>& chosen,
                                              const Vec3<Real>& org,
                                              const Vec3<Real>& center,
                                              const Real& radius,
                                              Real& power) {
  constexpr int n = kWidth<Real>;
  float o[3][n], c[3][n], r[n], out[n];
  store(o[0], org.x);
  store(o[1], org.y);
  store(o[2], org.z);
  store(c[0], center.x);
  store(c[1], center.y);
  store(c[2], center.z);
  store(r, radius);
  store(out, power);
  const unsigned lanes = bits(chosen);
  for (int i = 0; i < n; ++i) {
    if (!(lanes >> i & 1))
      continue;
    double sum = 0;
    for (int a = 0; a < 3; ++a) {
      const double d = static_cast<double>(c[a][i]) - o[a][i];
      sum += d * d;
    }
    out[i] = static_cast<float>(sum - static_cast<double>(r[i]) * r[i]);
  }
  load(out, power);
}

/// First point of each ray on one sphere, from outside or inside.
///
/// Shapes    rays and spheres pair up lane by lane; either side may be a broadcast.
/// Units     center, radius: scene units; t: multiples of dir. inv_dd is 1 / dot(dir, dir),
///           computed once a ray.
/// Requires  |radius| > 0; a negative radius shows only the inside. A lane with a NaN reports a
///           miss.
/// Returns   lanes whose t is above t_min; t is written in all lanes and means nothing in the
///           others.
/// Accuracy  hit point within 8 eps max(|radius|, |org - center|) of the surface
///           (tests/sphere_test.cpp); t within 1e-3 of itself for one met from 1e-6 radii above
///           (tests/stability/spheres.cpp).
/// Source    Haines, Günther, Akenine-Möller, "Precision Improvements for Ray/Sphere
///           Intersection", Ray Tracing Gems (2019), ch. 7, in units of t so that
///           one division is left.
template <class Real>
[[gnu::always_inline]] inline Mask<Real> hit_sphere(const Vec3<Real>& org,
                                                    const Vec3<Real>& dir,
                                                    const Real& inv_dd,
                                                    const Real& t_min,
                                                    const Vec3<Real>& center,
                                                    const Real& radius,
                                                    Real& t) {
  const Vec3<Real> to_center = center - org;
  const Real middle = dot(to_center, dir) * inv_dd;
  const Vec3<Real> gap = middle * dir - to_center;  // center to the line's nearest point
  const Real rr = radius * radius;
  const Real inside = rr - dot(gap, gap);  // b*b - a*c would cancel from afar
  const Mask<Real> crosses = inside >= Real(0);
  if (none(crosses))
    return crosses;
  const Real half = square_root(inside * inv_dd);
  // like signs add: nothing cancels
  const Real q = select(middle < Real(0), middle - half, middle + half);
  Real power = dot(to_center, to_center) - rr;
  // Of a ray that comes down on a sphere from close above, a floor, the squares leave little but
  // their rounding.
  const Mask<Real> close =
      both(both(crosses, middle > Real(0)), both(power > Real(0), Real(1024) * power < rr));
  if constexpr (sizeof(Scalar<Real>) == sizeof(float))
    if (any(close))
      exact_power<Real>(close, org, center, radius, power);
  const Real other = (power * inv_dd) / q;
  const Real enter = lesser(other, q), leave = greater(other, q);
  t = select(both(enter > t_min, radius > Real(0)), enter, leave);
  return both(crosses, t > t_min);
}

}  // namespace grelha::GRELHA_ISA
