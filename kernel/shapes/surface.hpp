#pragma once
// The surface at a hit: the point, its normals, and how far away from it a new ray must start.
//
// A ray that leaves a surface must not hit it again, nor skip what lies close. The point is
// computed from the primitive, not from org + t dir, which is off by eps times the distance
// travelled; the remaining error (`offset`) is bounded from the primitive's size and position:
// pbrt's idea (Pharr, Jakob, Humphreys, PBR 4th ed., 6.8), one scalar bound for all axes.
// Derivations: docs/proofs.md; kept by leaving_test.cpp.

#include "kernel/shapes/shapes.hpp"

namespace grelha::GRELHA_ISA {

/// Surfaces of primitives `id` at the rays' hits; undefined in lanes without a hit. Only kinds that
/// some lane hit are computed; mostly it is one. If the hit is the `first` crossing beyond t = 0,
/// only cones need t. `color`, unless null, gets the mixed colours of triangles' vertices; 1 in
/// other lanes.
template <class Real>
inline Surface<Real> surface_of(const GeometryView& g,
                                const Words<Real>& id,
                                const Vec3<Real>& org,
                                const Vec3<Real>& dir,
                                const Real& t,
                                bool smooth,
                                bool first = false,
                                Vec3<Real>* color = nullptr) {
  const Vec3<Real> at{org.x + t * dir.x, org.y + t * dir.y, org.z + t * dir.z};
  const SurfaceHit<Real> met{
      .org = org,
      .dir = dir,
      .t = t,
      .first = first,
      .at = at,
      .smooth = smooth,
      .color = color,
  };
  Surface<Real> s{};
  const Real white(1);
  if (color)
    *color = {white, white, white};
  // Inlined, or the linker could take another file's, compiled with other flags.
  for_each_shape([&]<class Shape>() __attribute__((always_inline)) {
    const std::uint32_t begin = g.ids.begin(Shape::kKind);
    const std::uint32_t count = g.ids.count(Shape::kKind);
    const auto here = id - begin < count;
    const Mask<Real> selected = mask_of(Words<Real>(here));
    if (none(selected))
      return;
    const typename Shape::Arrays& arrays = g.of<Shape>();
    const Surface<Real> f = surface_on(arrays, Words<Real>(here ? id - begin : Words<Real>{}), met);
    if (Shape::kKind == PrimitiveKind::kTriangle && color)
      *color = select(selected, *color, Vec3<Real>{white, white, white});
    s = {select(selected, f.point, s.point),
         select(selected, f.normal, s.normal),
         select(selected, f.shading, s.shading),
         select(selected, f.offset, s.offset),
         here ? f.material : s.material};
  });
  return s;
}

/// Origin of a ray that leaves `point` on the side its direction points to. `normal` is unit.
template <class Real>
inline Vec3<Real> offset_origin(const Vec3<Real>& point,
                                const Vec3<Real>& normal,
                                const Real& offset,
                                const Vec3<Real>& dir) {
  return point + select(dot(dir, normal) < Real(0), Real(0) - offset, offset) * normal;
}

}  // namespace grelha::GRELHA_ISA
