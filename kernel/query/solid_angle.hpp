#pragma once
// Solid angles of triangles, by + - * / and square roots alone.

#include <initializer_list>

#include "kernel/shapes/hit.hpp"
#include "kernel/shapes/triangle.hpp"

namespace grelha::GRELHA_ISA {

/// atan(y / x) of a point (x, y) in the right half plane or the left one, from -pi to pi; 0 where
/// both are 0. Within 2^-50.
///
/// The ratio of the lesser to the greater is turned back by 0, pi / 8 or pi / 4, which leaves at
/// most tan(pi / 16) < .199: the series ends with an error below .199^21 / 21 < 2^-53.
template <class Real>
[[gnu::always_inline]] inline Real angle_of(const Real& x, const Real& y) {
  constexpr double kPi = 0x1.921fb54442d18p+1;
  constexpr double kTan1 = 0x1.975f5e0553158p-3;  // of pi / 16
  constexpr double kTan2 = 0x1.a827999fcef32p-2;  // of pi / 8
  constexpr double kTan3 = 0x1.561b82ab7f990p-1;  // of 3 pi / 16
  const Real o(0), ax = magnitude(x), ay = magnitude(y);
  const Real less = min(ax, ay), more = max(ax, ay);
  const auto above_first = less > Real(kTan1) * more;
  const auto above_second = less > Real(kTan3) * more;
  const Real tan = select(above_second, Real(1), select(above_first, Real(kTan2), o));
  const Real turned = select(above_second, Real(kPi / 4), select(above_first, Real(kPi / 8), o));
  const Real rest = (less - tan * more) / (more + tan * less);
  const Real square = rest * rest;
  Real series(1. / 19);
  for (const double odd : {17., 15., 13., 11., 9., 7., 5., 3., 1.})
    series = Real(1 / odd) - square * series;
  Real angle = turned + rest * series;
  angle = select(ay > ax, Real(kPi / 2) - angle, angle);
  angle = select(x < o, Real(kPi) - angle, angle);
  return select(more > o, select(y < o, o - angle, angle), o);
}

/// Times the product of the three distances: numbers smaller than that, whose parts are off by 20
/// u, are computed anew in 106 bits. They are so near an edge alone.
inline constexpr double kLeastParts = 0x1p-8;
/// The same of a volume in double whose sign is known.
inline constexpr double kVolumeError = 0x1p-47;

/// Half the solid angles of the triangles of a block, positive where their corners are clockwise as
/// seen from the point; 0 where it lies in one. docs/numerics.md derives the error: 2^-40 where no
/// edge is nearer than 2^-24 of its length.
///
/// Source  Van Oosterom, Strackee, "The Solid Angle of a Plane Triangle", 1983.
inline void half_angles(const double (&p)[3], const TriangleBlock& block, double (&angle)[kBlock]) {
  for (int i = 0; i < kBlock; i += kWidth<VDouble>) {
    const auto way = [&](const float(&v)[3][kBlock]) {
      return Vec3<VDouble>{take<VDouble>(v[0] + i) - VDouble(p[0]),
                           take<VDouble>(v[1] + i) - VDouble(p[1]),
                           take<VDouble>(v[2] + i) - VDouble(p[2])};
    };
    const Vec3<VDouble> a = way(block.a), b = way(block.b), c = way(block.c);
    const VDouble la = length(a), lb = length(b), lc = length(c);
    const VDouble lengths = la * lb * lc;
    VDouble volume = dot(cross(a, b), c);
    VDouble real = lengths + (dot(a, b) * lc + (dot(b, c) * la + dot(c, a) * lb));
    const auto no_volume = magnitude(volume) <= VDouble(kVolumeError) * lengths;
    const auto small = max_abs(real, volume) <= VDouble(kLeastParts) * lengths;
    const unsigned unsure = bits(mask_or(small, mask_and(real < VDouble(0), no_volume)));
    if (unsure != 0) [[unlikely]] {
      double reals[kWidth<VDouble>], volumes[kWidth<VDouble>];
      store(reals, real);
      store(volumes, volume);
      each_bit(unsure, [&](int k) {
        const SolidAngleParts parts = solid_angle_parts(p, triangle_of(block, i + k).corner);
        reals[k] = parts.real;
        volumes[k] = parts.volume;
      });
      load(reals, real);
      load(volumes, volume);
    }
    const VDouble half = angle_of(real, volume);
    store(angle + i, select(volume == VDouble(0), VDouble(0), half));
  }
}

}  // namespace grelha::GRELHA_ISA
