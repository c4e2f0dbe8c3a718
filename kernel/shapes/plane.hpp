#pragma once

#include "kernel/simd/vec3.hpp"

namespace grelha::GRELHA_ISA {

/// Point where each ray meets an infinite plane, from either side; parallel rays miss. Accuracy: t
/// within 6 eps (|point - org| |normal| / |dot(dir, normal)| + |t| (1 + 1 / sin)) of the exact one,
/// sin that of the angle between ray and plane (plane_test.cpp).
template <class Real>
[[gnu::always_inline]] inline Mask<Real> hit_plane(const Vec3<Real>& org,
                                                   const Vec3<Real>& dir,
                                                   const Real& t_min,
                                                   const Vec3<Real>& point,
                                                   const Vec3<Real>& normal,
                                                   Real& t) {
  const Real along = dot(dir, normal);
  t = dot(point - org, normal) / along;
  return both(along != Real(0), t > t_min);
}

}  // namespace grelha::GRELHA_ISA
