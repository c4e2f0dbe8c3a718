#pragma once
// Rays as the tests of primitives see them, and what a test finds.

#include <type_traits>

#include "kernel/shapes/crossing.hpp"
#include "kernel/base/vec3.hpp"

namespace grelha::GRELHA_ISA {

/// Rays as the caller gave them, for cases that tests cannot decide: element i of each array.
struct GivenRays {
  const float* org[3] = {};
  const float* dir[3] = {};
  const float* t_min = nullptr;
  const float* t_max = nullptr;   ///< read while a ray has hit nothing
  const float* unit = nullptr;    ///< length in which t counts, but not t_min and t_max; null: 1
  const double* shift = nullptr;  ///< t of a given ray minus t of the tested one; null: 0

  ExactRay ray(int i) const {
    const double by = unit ? unit[i] : 1;
    return {{org[0][i], org[1][i], org[2][i]},
            {dir[0][i], dir[1][i], dir[2][i]},
            by * t_min[i],
            by * t_max[i]};
  }
  double shift_of(int i) const { return shift ? shift[i] : 0; }
};

/// Rays side by side, or one ray in all lanes. In the frame of a grid, tests subtract `base` from
/// the coordinates of primitives.
template <class Real>
struct SimdRays {
  Vec3<Real> org, dir;
  Real inv_dd;      ///< 1 / dot(dir, dir)
  Real inv_length;  ///< see inverse_length
  Real t_min;
  Real frame_error;             ///< error of coordinates in the frame
  Real error_bound;             ///< kFarError times the greatest distance to a primitive, or
                                ///< infinity
  const float* base = nullptr;  ///< x, y, z; null: 0
  const GivenRays* given = nullptr;
  int first = 0;  ///< index of the first lane among those given
  int step = 0;   ///< 1: a ray a lane; 0: one in all

  /// From the rays to points of primitives.
  [[gnu::always_inline]] Vec3<Real> to(const Vec3<Real>& point) const {
    if (!base)
      return point - org;
    return (point - Vec3<Real>{Real(base[0]), Real(base[1]), Real(base[2])}) - org;
  }
};

/// At least 1 / |dir| and at most sqrt 3 times as much, without a square root. Off by 5 u.
template <class Real>
[[gnu::always_inline]] inline Real inverse_length(const Vec3<Real>& dir, const Real& inv_dd) {
  const Vec3<Real> size = sizes(dir);
  return ((size.x + size.y) + size.z) * inv_dd;
}

/// Half an ulp of 1.
template <class Real>
inline constexpr double kUnit = std::is_same_v<Scalar<Real>, float> ? 0x1p-24 : 0x1p-53;
/// `count` half ulps of 1, as a Real.
template <class Real>
[[gnu::always_inline]] inline Real units(double count) {
  return Real(static_cast<Scalar<Real>>(count * kUnit<Real>));
}
/// Products of four lengths below this may have underflowed.
template <class Real>
inline constexpr double kUnderflow = std::is_same_v<Scalar<Real>, float> ? 0x1p-100 : 0x1p-900;

/// The first crossings beyond t_min and before t_max that tests find. Lanes that are not `some`
/// have none; lanes that are `sure` have one, at t from lo to hi.
template <class Real>
struct HitInterval {
  Mask<Real> some, sure;
  Real lo, hi;
};

}  // namespace grelha::GRELHA_ISA
