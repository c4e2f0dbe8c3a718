#pragma once
// Where a ray met its primitive: the point, its normals, and how far a new ray must start away from
// it.
//
// A ray that leaves a surface must not meet it again, nor skip what lies close. The point is taken
// from the primitive, not from org + t dir, which is off by eps times the distance travelled; what
// error is left (`away`) is bounded from the primitive's size and place: pbrt's idea (Pharr, Jakob,
// Humphreys, PBR 4th ed., 6.8), one scalar bound for all axes. Derivations: docs/numerics.md; kept
// by leaving_test.cpp.

#include "kernel/shapes/geometry_view.hpp"

namespace grelha::GRELHA_ISA {

/// Surfaces of primitives `id`, where rays met them; of lanes that met nothing, anything. What the
/// lanes met decides which kinds are looked at; mostly it is one.
template <class Real>
inline Surface<Real> surface_of(const GeometryView& g,
                                const Words<Real>& id,
                                const Vec3<Real>& org,
                                const Vec3<Real>& dir,
                                const Real& t,
                                bool smooth,
                                const ExactStart<Real>& start = {{Real(0), Real(0), Real(0)},
                                                                 nullptr}) {
  const Vec3<Real> at{org.x + t * dir.x, org.y + t * dir.y, org.z + t * dir.z};
  const Meeting<Real> met{
      .org = org,
      .dir = dir,
      .t = t,
      .at = at,
      .smooth = smooth,
      .start = start,
  };
  Surface<Real> s{};
  // Inlined, or the linker could take another file's, compiled with other flags.
  for_each_shape([&]<class Shape>() __attribute__((always_inline)) {
    const std::uint32_t first = g.ids.begin(Shape::kKind);
    const std::uint32_t count = g.ids.count(Shape::kKind);
    const auto here = id - first < count;
    const Mask<Real> chosen = mask_of(Words<Real>(here));
    if (none(chosen))
      return;
    const typename Shape::Arrays& arrays = g.of<Shape>();
    const Surface<Real> f = surface_on(arrays, Words<Real>(here ? id - first : Words<Real>{}), met);
    s = {select(chosen, f.point, s.point),
         select(chosen, f.normal, s.normal),
         select(chosen, f.shading, s.shading),
         select(chosen, f.away, s.away),
         here ? f.material : s.material,
         start.t ? select(chosen, f.low, s.low) : s.low};
  });
  return s;
}

/// Where a ray that leaves `point` on the side its direction points to must start. `normal` is
/// unit.
template <class Real>
inline Vec3<Real> leave(const Vec3<Real>& point,
                        const Vec3<Real>& normal,
                        const Real& away,
                        const Vec3<Real>& dir) {
  return point + select(dot(dir, normal) < Real(0), Real(0) - away, away) * normal;
}

/// A point as a sum of two floats.
template <class Real>
struct TwoFloats {
  Vec3<Real> high, low;
};

template <class Real, int i = 0>
inline void moved_points(const TwoFloats<Real>& from,
                         const Vec3<Real>& normal,
                         const Real& by,
                         PlaceParts<Real>& to) {
  const Vec3<Wide<Real>> p = widen<i>(from.high, from.low) + widen<i>(by) * widen<i>(normal);
  to.part[0][i] = p.x;
  to.part[1][i] = p.y;
  to.part[2][i] = p.z;
  if constexpr (i + 1 < kWideParts<Real>)
    moved_points<Real, i + 1>(from, normal, by, to);
}

/// A point moved along a unit vector, in double.
template <class Real>
inline TwoFloats<Real> moved_exactly(const TwoFloats<Real>& from,
                                     const Vec3<Real>& normal,
                                     const Real& by) {
  PlaceParts<Real> parts;
  moved_points<Real>(from, normal, by, parts);
  const Vec3<Real> high = parts.vector(0);
  rest_of_points<Real>(high, parts);
  return {high, parts.vector(0)};
}

}  // namespace grelha::GRELHA_ISA
