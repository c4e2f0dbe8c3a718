#pragma once
// How light is bent and split where it passes through a surface: lane by lane.

#include "kernel/base/vec3.hpp"

namespace grelha::GRELHA_ISA {

/// Snell's law at hits.
template <class Real>
struct Refraction {
  Real eta;                 ///< index of refraction of the viewer's side over that of the other
  Real cosine;              ///< to the viewer
  Real other_cosine;        ///< on the other side
  Mask<Real> is_refracted;  ///< else: total reflection
};

/// `nv`: cosine between normal and viewer.
template <class Real>
[[gnu::always_inline]] inline Refraction<Real> snell(const Real& ior,
                                                     const Mask<Real>& inside,
                                                     const Real& nv) {
  const Real o(0), one(1);
  const Real eta = select(inside, ior, one / ior);
  const Real cosine = max(nv, o);
  const Real squared = one - (eta * eta) * (one - cosine * cosine);  // of the other
  return {
      eta,
      cosine,
      square_root(max(squared, o)),
      squared >= o,
  };
}

/// The direction that passes, not yet normalized; v: the unit vector to the viewer, n: the normal
/// on its side.
template <class Real>
[[gnu::always_inline]] inline Vec3<Real> refracted_direction(const Refraction<Real>& f,
                                                             const Vec3<Real>& n,
                                                             const Vec3<Real>& v) {
  return (f.eta * f.cosine - f.other_cosine) * n - f.eta * v;
}

/// Schlick's share of the mirror, by the angle on the thinner side.
template <class Real>
[[gnu::always_inline]] inline Real schlick(const Real& ior, const Refraction<Real>& f) {
  const Real one(1);
  const Real cosine = select(f.eta > one, f.other_cosine, f.cosine);
  const Real r = (ior - one) / (ior + one);
  const Real r0 = r * r;
  const Real c = one - cosine;
  const Real cc = c * c;
  return r0 + (one - r0) * ((cc * cc) * c);
}

}  // namespace grelha::GRELHA_ISA
