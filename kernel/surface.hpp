#pragma once
// Where a ray met its primitive: the point, its normals, and how far a new ray must start away from it.
//
// A ray that leaves a surface must not meet it again, nor skip what lies close. The point is taken from the primitive, not
// from org + t dir, which is off by eps times the distance travelled; what error is left (`away`) is bounded from the
// primitive's size and place: pbrt's idea (Pharr, Jakob, Humphreys, PBR 4th ed., 6.8), one scalar bound for all axes.
// Derivations: docs/numerics.md; kept by tests/leaving_test.cpp.

#include "kernel/shading_view.hpp"
#include "kernel/single.hpp"

namespace grelha::GRELHA_ISA {

inline constexpr float kEps = 5.9604645e-8f;  ///< half an ulp of 1

/// What double takes from a point of a triangle, of its largest coordinate: some 30 roundings of 2^-53.
inline constexpr float kWideEps = 0x1p-48f;

template <class Real>
struct Surface {
  Vec3<Real> point, normal, shading;  ///< outward geometric normal, unit; shading normal, unit, same side
  Real away;
  Words<Real> material;
};

/// Three numbers of the primitives, or vertices, i.
template <class Word>
inline auto three_at(const float* x, const float* y, const float* z, const Word& i) {
  return Vec3<decltype(floats_at(x, i))>{floats_at(x, i), floats_at(y, i), floats_at(z, i)};
}

template <class Real>
inline Surface<Real> plane_surface(const GeometryView& g, const Words<Real>& i, const Vec3<Real>& at) {
  const Vec3<Real> p = three_at(g.px, g.py, g.pz, i), n = normalize(three_at(g.pnx, g.pny, g.pnz, i));
  return {at - dot(at - p, n) * n, n, n, Real(8 * kEps) * (largest(at) + largest(p)), words_at(g.plane_material, i)};
}

template <class Real>
inline Surface<Real> sphere_surface(const GeometryView& g, const Words<Real>& i, const Vec3<Real>& at) {
  const Vec3<Real> c = three_at(g.sx, g.sy, g.sz, i), n = normalize(at - c);
  const Real r = magnitude(floats_at(g.sr, i));
  const Vec3<Real> point = c + r * n;
  return {point, n, n, Real(16 * kEps) * r + Real(4 * kEps) * largest(point), words_at(g.sphere_material, i)};
}

template <class Real>
inline Surface<Real> cone_surface(const GeometryView& g, const Words<Real>& i, const Vec3<Real>& at) {
  const Vec3<Real> base = three_at(g.cone[0], g.cone[1], g.cone[2], i), axis = three_at(g.cone[3], g.cone[4], g.cone[5], i);
  const Real height = floats_at(g.cone[6], i), radius = floats_at(g.cone[7], i), slope = floats_at(g.cone[8], i);
  const Vec3<Real> from_base = at - base;
  const Real along = dot(from_base, axis);
  const Real h = select(along < Real(0), Real(0), select(along > height, height, along));
  const Vec3<Real> radial = from_base - h * axis;
  Vec3<Real> u, v;
  across(axis, u, v);
  const Vec3<Real> out = select(dot(radial, radial) > Real(0), normalize(radial), u);  // on a tip all directions are as good
  const Vec3<Real> point = base + h * axis + (radius + slope * h) * out, n = normalize(out - slope * axis);
  return {point, n, n, Real(32 * kEps) * (height + (radius + slope * height)) + Real(4 * kEps) * largest(point), words_at(g.cone_material, i)};
}

/// What of a triangle's surface is computed in double, and rounded once.
template <class Real>
struct TrianglePlace {
  Vec3<Real> point, normal, weights;
};

/// Corners as they are, not permuted; `axis` is that of shear_axis(). Rays that do not cross are taken to the first corner.
template <class Real>
inline TrianglePlace<Real> triangle_place(const Real& axis, const Vec3<Real>& org, const Vec3<Real>& dir, const Corners<Real>& c) {
  const auto turned = [&](const Vec3<Real>& p) { return permuted<Real>(axis, p); };
  const Crossing<Real> r = crossing<Real>(turned(org), turned(dir), {turned(c.a), turned(c.b), turned(c.c)});
  const Real o(0), one(1);
  const Vec3<Real> w = select(r.inside, r.weights, Vec3<Real>{one, o, o}), e1 = c.b - c.a, e2 = c.c - c.a;
  return {c.a + (w.y * e1 + w.z * e2), normalize(cross(e1, e2)), w};
}

template <class Real>
struct PlaceParts {
  Wide<Real> part[9][kWideParts<Real>];
  Vec3<Real> vector(int i) const { return {narrow<Real>(part[i]), narrow<Real>(part[i + 1]), narrow<Real>(part[i + 2])}; }
};

template <class Real, int i = 0>
inline void place_parts(const Real& axis, const Vec3<Real>& org, const Vec3<Real>& dir, const Corners<Real>& c, PlaceParts<Real>& to) {
  const TrianglePlace<Wide<Real>> p = triangle_place<Wide<Real>>(widen<i>(axis), widen<i>(org), widen<i>(dir), widen<i>(c));
  int k = 0;
  for (const Vec3<Wide<Real>>* v : {&p.point, &p.normal, &p.weights})
    for (const Wide<Real>* x : {&v->x, &v->y, &v->z}) to.part[k++][i] = *x;
  if constexpr (i + 1 < kWideParts<Real>) place_parts<Real, i + 1>(axis, org, dir, c, to);
}

template <class Real>
inline Surface<Real> triangle_surface(const GeometryView& g, const Words<Real>& i, const Vec3<Real>& org, const Vec3<Real>& dir, bool smooth) {
  const Words<Real> v[3] = {words_at(g.ta, i), words_at(g.tb, i), words_at(g.tc, i)};
  const Vec3<Real> a = three_at(g.tx, g.ty, g.tz, v[0]), b = three_at(g.tx, g.ty, g.tz, v[1]), c = three_at(g.tx, g.ty, g.tz, v[2]);
  const Real o(0), one(1), mx = magnitude(dir.x), my = magnitude(dir.y), mz = magnitude(dir.z);
  // the axis prepare() gave the ray
  const Real axis = select(both(mx >= my, mx >= mz), o, select(my >= mz, one, Real(2)));
  PlaceParts<Real> place;
  place_parts<Real>(axis, org, dir, {a, b, c}, place);
  const Vec3<Real> point = place.vector(0), n = place.vector(3), w = place.vector(6);
  const Real corners = greater(greater(largest(a), largest(b)), largest(c));
  Surface<Real> s{point, n, n, Real(4 * kEps) * largest(point) + Real(kWideEps) * corners, words_at(g.triangle_material, i)};
  if (!smooth) return s;
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
inline Surface<Real> surface_of(const SceneView& scene, const Words<Real>& id, const Vec3<Real>& org, const Vec3<Real>& dir, const Real& t,
                                bool smooth) {
  const GeometryView& g = scene.geometry;
  const Vec3<Real> at{org.x + t * dir.x, org.y + t * dir.y, org.z + t * dir.z};
  Surface<Real> s{};
  const auto of_kind = [&](std::uint32_t first, std::uint32_t end, const auto& surface) {
    const auto here = id - first < end - first;
    const Mask<Real> chosen = mask_of(Words<Real>(here));
    if (none(chosen)) return;
    const Surface<Real> f = surface(Words<Real>(here ? id - first : Words<Real>{}));
    s = {select(chosen, f.point, s.point), select(chosen, f.normal, s.normal), select(chosen, f.shading, s.shading),
         select(chosen, f.away, s.away), here ? f.material : s.material};
  };
  of_kind(0, scene.sphere_base, [&](const Words<Real>& i) { return plane_surface<Real>(g, i, at); });
  of_kind(scene.sphere_base, scene.triangle_base, [&](const Words<Real>& i) { return sphere_surface<Real>(g, i, at); });
  of_kind(scene.triangle_base, scene.cone_base, [&](const Words<Real>& i) { return triangle_surface<Real>(g, i, org, dir, smooth); });
  of_kind(scene.cone_base, scene.primitive_end, [&](const Words<Real>& i) { return cone_surface<Real>(g, i, at); });
  return s;
}

/// Where a ray that leaves `point` on the side its direction points to must start. `normal` is unit.
template <class Real>
inline Vec3<Real> leave(const Vec3<Real>& point, const Vec3<Real>& normal, const Real& away, const Vec3<Real>& dir) {
  return point + select(dot(dir, normal) < Real(0), Real(0) - away, away) * normal;
}

}  // namespace grelha::GRELHA_ISA
