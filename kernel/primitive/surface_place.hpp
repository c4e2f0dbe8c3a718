#pragma once
// A place on the surface of a primitive, in the precision that its ray was traced in.

#include <type_traits>

#include "kernel/primitive/field_lanes.hpp"
#include "kernel/simd/vec3.hpp"

namespace grelha::GRELHA_ISA {

inline constexpr float kEps = 5.9604645e-8f;  ///< half an ulp of 1

/// What double takes from a point of a triangle, of its largest coordinate: some 30 roundings of
/// 2^-53.
inline constexpr float kWideEps = 0x1p-48f;

template <class Real>
struct Surface {
  Vec3<Real> point, normal,
      shading;  ///< outward geometric normal, unit; shading normal, unit, same side
  Real away;
  Words<Real> material;
  Vec3<Real> low;  ///< of a ray traced in double: what the point has besides
};

/// A point of a primitive, the outward unit normal there and how far a ray must start from it, in
/// the precision of Real.
template <class Real>
struct SurfacePlace {
  Vec3<Real> point, normal;
  Real away;
};

/// One rounding of what new rays start from: of floats, or of sums of two floats, 2^-48 of the
/// first, and of doubles.
template <class Real>
inline constexpr Scalar<Real> kRounding = sizeof(Scalar<Real>) == sizeof(float)
                                              ? Scalar<Real>(kEps)
                                              : Scalar<Real>(0x1p-47);

/// Three numbers of the vertices i.
template <class Word>
inline auto three_at(const float* const (&v)[3], const Word& i) {
  return Vec3<decltype(floats_at(v[0], i))>{
      floats_at(v[0], i), floats_at(v[1], i), floats_at(v[2], i)};
}

/// Vectors and numbers in double, part after part of the lanes.
template <class Real>
struct PlaceParts {
  Wide<Real> part[10][kWideParts<Real>];
  Vec3<Real> vector(int i) const {
    return {
        narrow<Real>(part[i]),
        narrow<Real>(part[i + 1]),
        narrow<Real>(part[i + 2]),
    };
  }
};

/// What a ray traced in double met a primitive with: the rest of its origin, and t.
template <class Real>
struct ExactStart {
  Vec3<Real> low;
  const double* t = nullptr;  ///< of each lane; null: the ray was traced in single
};

/// `place` of part after part of the lanes, at the points where rays in double are at t.
template <class Real, int i = 0, class PlaceOf>
inline void exact_places(const ExactStart<Real>& start,
                         const Vec3<Real>& org,
                         const Vec3<Real>& dir,
                         const PlaceOf& place,
                         PlaceParts<Real>& to) {
  using W = Wide<Real>;
  const W t = load<W>(start.t + i * kWidth<W>);
  const SurfacePlace<W> p =
      place(std::integral_constant<int, i>{}, widen<i>(org, start.low) + t * widen<i>(dir));
  int k = 0;
  for (const Vec3<W>* v : {&p.point, &p.normal})
    for (const W* x : {&v->x, &v->y, &v->z})
      to.part[k++][i] = *x;
  to.part[k][i] = p.away;
  if constexpr (i + 1 < kWideParts<Real>)
    exact_places<Real, i + 1>(start, org, dir, place, to);
}

/// What rounding to floats takes from points in double.
template <class Real, int i = 0>
inline void rest_of_points(const Vec3<Real>& point, PlaceParts<Real>& parts) {
  const Vec3<Wide<Real>> p = widen<i>(point);
  parts.part[0][i] = parts.part[0][i] - p.x;
  parts.part[1][i] = parts.part[1][i] - p.y;
  parts.part[2][i] = parts.part[2][i] - p.z;
  if constexpr (i + 1 < kWideParts<Real>)
    rest_of_points<Real, i + 1>(point, parts);
}

/// Rays and where they met their primitives.
template <class Real>
struct Meeting {
  const Vec3<Real>&org, &dir;
  const Real& t;
  Vec3<Real> at;  ///< org + t dir
  bool smooth;    ///< normals of vertices are mixed
  const ExactStart<Real>& start;
};

/// A surface of `place`, which computes it in the precision the ray was traced in: of floats, or in
/// double.
template <class Real, class PlaceOf, class ExactPlaceOf>
inline Surface<Real> surface_at(const Meeting<Real>& met,
                                const PlaceOf& place,
                                const ExactPlaceOf& exact_place,
                                const Words<Real>& material) {
  const Vec3<Real> zero{Real(0), Real(0), Real(0)};
  if (!met.start.t) {
    const SurfacePlace<Real> p = place();
    return {p.point, p.normal, p.normal, p.away, material, zero};
  }
  PlaceParts<Real> parts;
  exact_places<Real>(met.start, met.org, met.dir, exact_place, parts);
  const Vec3<Real> point = parts.vector(0);
  const Vec3<Real> n = parts.vector(3);
  rest_of_points<Real>(point, parts);
  return {
      point,
      n,
      n,
      narrow<Real>(parts.part[6]),
      material,
      parts.vector(0),
  };
}

}  // namespace grelha::GRELHA_ISA
