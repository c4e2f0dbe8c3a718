#pragma once
// A position on the surface of a primitive, in the precision that its ray was traced in.

#include <type_traits>

#include "kernel/shapes/arrays.hpp"
#include "kernel/base/vec3.hpp"

namespace grelha::GRELHA_ISA {

inline constexpr float kEps = 5.9604645e-8f;  ///< half an ulp of 1

/// A point of a triangle in double: error <= kWideEps * its largest coordinate, some 30 roundings
/// of 2^-53.
inline constexpr float kWideEps = 0x1p-48f;

template <class Real>
struct Surface {
  Vec3<Real> point, normal,
      shading;  ///< outward geometric normal, unit; shading normal, unit, same side
  Real offset;
  Words<Real> material;
};

/// A point of a primitive, the outward unit normal there and how far a ray must start from it, in
/// the precision of Real.
template <class Real>
struct SurfacePosition {
  Vec3<Real> point, normal;
  Real offset;
};

/// Three numbers of the vertices i.
template <class Word>
inline auto three_at(const float* const (&v)[3], const Word& i) {
  return Vec3<decltype(floats_at(v[0], i))>{
      floats_at(v[0], i), floats_at(v[1], i), floats_at(v[2], i)};
}

/// Vectors and numbers in double, part after part of the lanes.
template <class Real>
struct PositionParts {
  Wide<Real> part[10][kWideParts<Real>];
  Vec3<Real> vector(int i) const {
    return {
        narrow<Real>(part[i]),
        narrow<Real>(part[i + 1]),
        narrow<Real>(part[i + 2]),
    };
  }
};

/// Rays and where they hit their primitives.
template <class Real>
struct SurfaceHit {
  const Vec3<Real>&org, &dir;
  const Real& t;
  bool first;                   ///< the hit is the first crossing beyond t = 0; t may be unknown
  Vec3<Real> at;                ///< org + t dir
  bool smooth;                  ///< normals of vertices are mixed
  Vec3<Real>* color = nullptr;  ///< where triangles put the mix of their vertices' colours, or null
};

/// The surface at a position.
template <class Real>
inline Surface<Real> surface_at(const SurfacePosition<Real>& p, const Words<Real>& material) {
  return {p.point, p.normal, p.normal, p.offset, material};
}

}  // namespace grelha::GRELHA_ISA
