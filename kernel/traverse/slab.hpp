#pragma once
// The slab test (Kay & Kajiya 1986) along one axis.

#include "kernel/base/lanes.hpp"

namespace grelha::GRELHA_ISA {

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

}  // namespace grelha::GRELHA_ISA
