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

/// A ball that touches a primitive's surface.
template <class Real>
struct Ball {
  Vec3<Real> center;
  Real radius;
};

/// Two points, and how far all that lies around the way between them is from it at most.
template <class Real>
struct Stretch {
  Vec3<Real> end[2];
  Real radius;
};

}  // namespace grelha::GRELHA_ISA
