#pragma once
// Where a ray met its primitive: the point, its normals, and how far a new ray must start away from it.
//
// A ray that leaves a surface must not meet it again, nor skip what lies close. The point is taken from the primitive, not
// from org + t dir, which is off by eps times the distance travelled; what error is left (`away`) is bounded from the
// primitive's size and place: pbrt's idea (Pharr, Jakob, Humphreys, PBR 4th ed., 6.8), one scalar bound for all axes.
// Derivations: docs/numerics.md; kept by leaving_test.cpp.

#include <type_traits>

#include "kernel/scene/shading_view.hpp"
#include "kernel/trace/single.hpp"

namespace grelha::GRELHA_ISA {

inline constexpr float kEps = 5.9604645e-8f;  ///< half an ulp of 1

/// What double takes from a point of a triangle, of its largest coordinate: some 30 roundings of 2^-53.
inline constexpr float kWideEps = 0x1p-48f;

template <class Real>
struct Surface {
  Vec3<Real> point, normal,
      shading;  ///< outward geometric normal, unit; shading normal, unit, same side
  Real away;
  Words<Real> material;
  Vec3<Real> low;  ///< of a ray traced in double: what the point has besides
};

/// A point of a primitive, the outward unit normal there and how far a ray must start from it, in the precision of Real.
template <class Real>
struct SurfacePlace {
  Vec3<Real> point, normal;
  Real away;
};

/// One rounding of what new rays start from: of floats, or of sums of two floats, 2^-48 of the first, and of doubles.
template <class Real>
inline constexpr Scalar<Real> kRounding = sizeof(Scalar<Real>) == sizeof(float)
                                              ? Scalar<Real>(kEps)
                                              : Scalar<Real>(0x1p-47);

/// Three numbers of the primitives, or vertices, i.
template <class Word>
inline auto three_at(const float* x, const float* y, const float* z, const Word& i) {
  return Vec3<decltype(floats_at(x, i))>{floats_at(x, i), floats_at(y, i), floats_at(z, i)};
}

/// Through `through`, across `across`, of any length.
template <class Real>
inline SurfacePlace<Real> plane_place(const Vec3<Real>& through,
                                      const Vec3<Real>& across,
                                      const Vec3<Real>& at) {
  const Vec3<Real> n = normalize(across);
  return {at - dot(at - through, n) * n,
          n,
          Real(8 * kRounding<Real>) * (largest(at) + largest(through))};
}

/// Vectors and numbers in double, part after part of the lanes.
template <class Real>
struct PlaceParts {
  Wide<Real> part[10][kWideParts<Real>];
  Vec3<Real> vector(int i) const {
    return {narrow<Real>(part[i]), narrow<Real>(part[i + 1]), narrow<Real>(part[i + 2])};
  }
};

/// Point and normal where a ray meets a sphere, in double: those of the crossing next to t.
template <class Real>
inline void sphere_crossing(const Vec3<Real>& org,
                            const Vec3<Real>& dir,
                            const Real& t,
                            const Vec3<Real>& center,
                            const Real& radius,
                            Vec3<Real>& point,
                            Vec3<Real>& normal) {
  const Vec3<Real> to_center = center - org;
  const Real inv_dd = Real(1) / dot(dir, dir);
  const Real middle = dot(to_center, dir) * inv_dd;
  const Vec3<Real> gap = middle * dir - to_center;
  const Real inside = greater(radius * radius - dot(gap, gap), Real(0));
  const Real half = square_root(inside * inv_dd);
  normal = normalize(gap + select(t < middle, Real(0) - half, half) * dir);
  point = center + radius * normal;
}

template <class Real, int i = 0>
inline void sphere_places(const Vec3<Real>& org,
                          const Vec3<Real>& dir,
                          const Real& t,
                          const Vec3<Real>& center,
                          const Real& radius,
                          PlaceParts<Real>& to) {
  Vec3<Wide<Real>> point;
  Vec3<Wide<Real>> normal;
  sphere_crossing<Wide<Real>>(
      widen<i>(org), widen<i>(dir), widen<i>(t), widen<i>(center), widen<i>(radius), point, normal);
  int k = 0;
  for (const Vec3<Wide<Real>>* v : {&point, &normal})
    for (const Wide<Real>* x : {&v->x, &v->y, &v->z})
      to.part[k++][i] = *x;
  if constexpr (i + 1 < kWideParts<Real>)
    sphere_places<Real, i + 1>(org, dir, t, center, radius, to);
}

/// Times the radius: a start that far off lets no ray meet the bulge whose cosine with the rounded
/// normal has the wrong sign, 64 u^2. It takes 13 u^2.
inline constexpr float kBulge = 0x1p-42f;

/// Of a ray traced in single, rounded once.
template <class Real>
inline SurfacePlace<Real> rounded_sphere_place(const Vec3<Real>& org,
                                               const Vec3<Real>& dir,
                                               const Real& t,
                                               const Vec3<Real>& c,
                                               const Real& r) {
  PlaceParts<Real> parts;
  sphere_places<Real>(org, dir, t, c, r, parts);
  const Vec3<Real> point = parts.vector(0);
  const Real p = largest(point);
  // The middle term spares most rays that leave the test in double; they would be as right without.
  const Real away = Real(4 * kEps) * p + Real(16 * kEps) * lesser(r, p) + Real(kBulge) * r;
  return {point, parts.vector(3), away};
}

template <class Real>
inline SurfacePlace<Real> sphere_place(const Vec3<Real>& c, const Real& r, const Vec3<Real>& at) {
  const Vec3<Real> n = normalize(at - c), point = c + r * n;
  return {point, n, Real(16 * kRounding<Real>) * r + Real(4 * kRounding<Real>) * largest(point)};
}

template <class Real>
inline SurfacePlace<Real> cone_place(const Vec3<Real>& base,
                                     const Vec3<Real>& axis,
                                     const Real& height,
                                     const Real& radius,
                                     const Real& slope,
                                     const Vec3<Real>& at) {
  const Vec3<Real> from_base = at - base;
  const Real along = dot(from_base, axis);
  const Real h = select(along < Real(0), Real(0), select(along > height, height, along));
  const Vec3<Real> radial = from_base - h * axis;
  Vec3<Real> u, v;
  across(axis, u, v);
  const Vec3<Real> out = select(
      dot(radial, radial) > Real(0), normalize(radial), u);  // on a tip all directions are as good
  const Vec3<Real> point = base + h * axis + (radius + slope * h) * out,
                   n = normalize(out - slope * axis);
  return {point,
          n,
          Real(32 * kRounding<Real>) * (height + (radius + slope * height)) +
              Real(4 * kRounding<Real>) * largest(point)};
}

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

/// A surface of `place`, which computes it in the precision the ray was traced in: of floats `at`, or in double.
template <class Real, class PlaceOf, class ExactPlaceOf>
inline Surface<Real> surface_at(const ExactStart<Real>& start,
                                const Vec3<Real>& org,
                                const Vec3<Real>& dir,
                                const PlaceOf& place,
                                const ExactPlaceOf& exact_place,
                                const Words<Real>& material) {
  const Vec3<Real> zero{Real(0), Real(0), Real(0)};
  if (!start.t) {
    const SurfacePlace<Real> p = place();
    return {p.point, p.normal, p.normal, p.away, material, zero};
  }
  PlaceParts<Real> parts;
  exact_places<Real>(start, org, dir, exact_place, parts);
  const Vec3<Real> point = parts.vector(0), n = parts.vector(3);
  rest_of_points<Real>(point, parts);
  return {point, n, n, narrow<Real>(parts.part[6]), material, parts.vector(0)};
}

/// Places on planes, spheres and cones in single, or of part i of the lanes in double.
template <class Real>
inline Surface<Real> plane_surface(const GeometryView& g,
                                   const Words<Real>& i,
                                   const ExactStart<Real>& start,
                                   const Vec3<Real>& org,
                                   const Vec3<Real>& dir,
                                   const Vec3<Real>& at) {
  const Vec3<Real> p = three_at(g.px, g.py, g.pz, i), n = three_at(g.pnx, g.pny, g.pnz, i);
  return surface_at<Real>(
      start,
      org,
      dir,
      [&] { return plane_place<Real>(p, n, at); },
      [&](auto k, const auto& here) { return plane_place(widen<k>(p), widen<k>(n), here); },
      words_at(g.plane_material, i));
}

template <class Real>
inline Surface<Real> sphere_surface(const GeometryView& g,
                                    const Words<Real>& i,
                                    const ExactStart<Real>& start,
                                    const Vec3<Real>& org,
                                    const Vec3<Real>& dir,
                                    const Real& t) {
  const Vec3<Real> c = three_at(g.sx, g.sy, g.sz, i);
  const Real r = magnitude(floats_at(g.sr, i));
  return surface_at<Real>(
      start,
      org,
      dir,
      [&] { return rounded_sphere_place<Real>(org, dir, t, c, r); },
      [&](auto k, const auto& here) { return sphere_place(widen<k>(c), widen<k>(r), here); },
      words_at(g.sphere_material, i));
}

template <class Real>
inline Surface<Real> cone_surface(const GeometryView& g,
                                  const Words<Real>& i,
                                  const ExactStart<Real>& start,
                                  const Vec3<Real>& org,
                                  const Vec3<Real>& dir,
                                  const Vec3<Real>& at) {
  const Vec3<Real> base = three_at(g.cone[0], g.cone[1], g.cone[2], i),
                   axis = three_at(g.cone[3], g.cone[4], g.cone[5], i);
  const Real height = floats_at(g.cone[6], i), radius = floats_at(g.cone[7], i),
             slope = floats_at(g.cone[8], i);
  return surface_at<Real>(
      start,
      org,
      dir,
      [&] { return cone_place<Real>(base, axis, height, radius, slope, at); },
      [&](auto k, const auto& here) {
        return cone_place(widen<k>(base),
                          widen<k>(axis),
                          widen<k>(height),
                          widen<k>(radius),
                          widen<k>(slope),
                          here);
      },
      words_at(g.cone_material, i));
}

/// What of a triangle's surface is computed in double, and rounded once.
template <class Real>
struct TrianglePlace {
  Vec3<Real> point, normal, weights;
};

/// Corners as they are, not permuted; `axis` is that of shear_axis(). Rays that do not cross are taken to the first corner.
template <class Real>
inline TrianglePlace<Real> triangle_place(const Real& axis,
                                          const Vec3<Real>& org,
                                          const Vec3<Real>& dir,
                                          const Corners<Real>& c) {
  const auto turned = [&](const Vec3<Real>& p) { return permuted<Real>(axis, p); };
  const Crossing<Real> r =
      crossing<Real>(turned(org), turned(dir), {turned(c.a), turned(c.b), turned(c.c)});
  const Real o(0), one(1);
  const Vec3<Real> w = select(r.inside, r.weights, Vec3<Real>{one, o, o}), e1 = c.b - c.a,
                   e2 = c.c - c.a;
  return {c.a + (w.y * e1 + w.z * e2), normalize(cross(e1, e2)), w};
}

template <class Real, int i = 0>
inline void triangle_places(const Real& axis,
                            const Vec3<Real>& org,
                            const Vec3<Real>& low,
                            const Vec3<Real>& dir,
                            const Corners<Real>& c,
                            PlaceParts<Real>& to) {
  const TrianglePlace<Wide<Real>> p =
      triangle_place<Wide<Real>>(widen<i>(axis), widen<i>(org, low), widen<i>(dir), widen<i>(c));
  int k = 0;
  for (const Vec3<Wide<Real>>* v : {&p.point, &p.normal, &p.weights})
    for (const Wide<Real>* x : {&v->x, &v->y, &v->z})
      to.part[k++][i] = *x;
  if constexpr (i + 1 < kWideParts<Real>)
    triangle_places<Real, i + 1>(axis, org, low, dir, c, to);
}

template <class Real>
inline Surface<Real> triangle_surface(const GeometryView& g,
                                      const Words<Real>& i,
                                      const ExactStart<Real>& start,
                                      const Vec3<Real>& org,
                                      const Vec3<Real>& dir,
                                      bool smooth) {
  const Words<Real> v[3] = {words_at(g.ta, i), words_at(g.tb, i), words_at(g.tc, i)};
  const Vec3<Real> a = three_at(g.tx, g.ty, g.tz, v[0]), b = three_at(g.tx, g.ty, g.tz, v[1]),
                   c = three_at(g.tx, g.ty, g.tz, v[2]);
  const Real o(0), one(1), mx = magnitude(dir.x), my = magnitude(dir.y), mz = magnitude(dir.z);
  // the axis prepare() gave the ray
  const Real axis = select(both(mx >= my, mx >= mz), o, select(my >= mz, one, Real(2)));
  PlaceParts<Real> place;
  triangle_places<Real>(axis, org, start.low, dir, {a, b, c}, place);
  const Vec3<Real> point = place.vector(0), n = place.vector(3), w = place.vector(6);
  const Real corners = greater(greater(largest(a), largest(b)), largest(c));
  Surface<Real> s{point,
                  n,
                  n,
                  Real(4 * kEps) * largest(point) + Real(kWideEps) * corners,
                  words_at(g.triangle_material, i),
                  {o, o, o}};
  if (start.t) {
    rest_of_points<Real>(point, place);
    s.low = place.vector(0);
    s.away =
        Real(4 * static_cast<float>(kRounding<double>)) * largest(point) + Real(kWideEps) * corners;
  }
  if (!smooth)
    return s;
  Mask<Real> sound = one > o;
  const auto vertex_normal = [&](const Words<Real>& vertex) {
    const Vec3<Real> m = three_at(g.tnx, g.tny, g.tnz, vertex);
    const Real mm = dot(m, m);
    sound = both(sound, mm > o);
    return (one / square_root(mm)) * m;
  };
  const Vec3<Real> na = vertex_normal(v[0]), nb = vertex_normal(v[1]), nc = vertex_normal(v[2]);
  const Vec3<Real> mix = w.x * na + (w.y * nb + w.z * nc);
  const Real mm = dot(mix, mix);
  const Vec3<Real> m = (one / square_root(mm)) * mix;
  const Vec3<Real> same_side = select(dot(m, n) < o, Vec3<Real>{o, o, o} - m, m);
  s.shading = select(both(sound, mm > Real(1e-12f)), same_side, n);
  return s;
}

/// Surfaces of primitives `id`, where rays met them; of lanes that met nothing, anything. What the lanes met decides which kinds
/// are looked at; mostly it is one.
template <class Real>
inline Surface<Real> surface_of(const SceneView& scene,
                                const Words<Real>& id,
                                const Vec3<Real>& org,
                                const Vec3<Real>& dir,
                                const Real& t,
                                bool smooth,
                                const ExactStart<Real>& start = {{Real(0), Real(0), Real(0)},
                                                                 nullptr}) {
  const GeometryView& g = scene.geometry;
  const Vec3<Real> at{org.x + t * dir.x, org.y + t * dir.y, org.z + t * dir.z};
  Surface<Real> s{};
  const auto of_kind = [&](std::uint32_t first, std::uint32_t end, const auto& surface) {
    const auto here = id - first < end - first;
    const Mask<Real> chosen = mask_of(Words<Real>(here));
    if (none(chosen))
      return;
    const Surface<Real> f = surface(Words<Real>(here ? id - first : Words<Real>{}));
    s = {select(chosen, f.point, s.point),
         select(chosen, f.normal, s.normal),
         select(chosen, f.shading, s.shading),
         select(chosen, f.away, s.away),
         here ? f.material : s.material,
         start.t ? select(chosen, f.low, s.low) : s.low};
  };
  of_kind(0, scene.sphere_base, [&](const Words<Real>& i) {
    return plane_surface<Real>(g, i, start, org, dir, at);
  });
  of_kind(scene.sphere_base, scene.triangle_base, [&](const Words<Real>& i) {
    return sphere_surface<Real>(g, i, start, org, dir, t);
  });
  of_kind(scene.triangle_base, scene.cone_base, [&](const Words<Real>& i) {
    return triangle_surface<Real>(g, i, start, org, dir, smooth);
  });
  of_kind(scene.cone_base, scene.primitive_end, [&](const Words<Real>& i) {
    return cone_surface<Real>(g, i, start, org, dir, at);
  });
  return s;
}

/// Where a ray that leaves `point` on the side its direction points to must start. `normal` is unit.
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
