#pragma once
// Rays as the tests of primitives see them.

#include "kernel/simd/vec3.hpp"

namespace grelha::GRELHA_ISA {

template <class Real>
struct RayLanes {
  Vec3<Real> org, dir;
  Real inv_dd;  ///< 1 / dot(dir, dir)
  Real t_min;
};

}  // namespace grelha::GRELHA_ISA
