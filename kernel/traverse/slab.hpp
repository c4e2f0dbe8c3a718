#pragma once
// The slab test (Kay & Kajiya 1986) along one axis.

#include "kernel/base/lanes.hpp"

namespace grelha::GRELHA_ISA {

/// A component of a direction, at least `least` in size.
template <class Real>
[[gnu::always_inline]] inline Real with_advance(const Real& component, const Real& least) {
  const Real o = least - least;
  return select(magnitude(component) < least, select(component < o, o - least, least), component);
}

/// Clips [t0, t1] to the interval between two planes across an axis, which rays cross at `near` and
/// then at `far`. A NaN, of a ray in a plane, clips nothing.
template <class Real>
[[gnu::always_inline]] inline void clip_to_slab(const Real& near,
                                                const Real& far,
                                                Real& t0,
                                                Real& t1) {
  t0 = max(near, t0);
  t1 = min(far, t1);
}

/// The same for planes at lo and hi, whichever a ray crosses first. `inverse`: of its direction.
template <class Real>
[[gnu::always_inline]] inline void clip_to_slab(
    const Real& lo, const Real& hi, const Real& org, const Real& inverse, Real& t0, Real& t1) {
  const Real x = (lo - org) * inverse;
  const Real y = (hi - org) * inverse;
  clip_to_slab(min(x, y), max(x, y), t0, t1);
}

}  // namespace grelha::GRELHA_ISA
