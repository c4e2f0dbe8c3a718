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

/// Unit normal of a triangle's edges. The square of their product overflows from 4e9 on and is 0 below 1e-10, so what is far from 1 is brought
/// nearer, by powers of two, which change no bit.
template <class Real>
inline Vec3<Real> across_both(const Vec3<Real>& e1, const Vec3<Real>& e2) {
  const Vec3<Real> n = cross(e1, e2);
  const Real size = largest(n);
  return normalize(select(size < Real(0x1p-40f), Real(0x1p80f), select(size > Real(0x1p40f), Real(0x1p-80f), Real(1))) * n);
}

template <class Real>
inline Surface<Real> triangle_surface(const GeometryView& g, const Words<Real>& i, const Vec3<Real>& org, const Vec3<Real>& dir, bool smooth) {
  const Words<Real> v[3] = {words_at(g.ta, i), words_at(g.tb, i), words_at(g.tc, i)};
  const Vec3<Real> a = three_at(g.tx, g.ty, g.tz, v[0]), b = three_at(g.tx, g.ty, g.tz, v[1]), c = three_at(g.tx, g.ty, g.tz, v[2]);
  const Real o(0), one(1), mx = magnitude(dir.x), my = magnitude(dir.y), mz = magnitude(dir.z);
  const Mask<Real> x_first = both(mx >= my, mx >= mz), y_first = my >= mz;  // the axis prepare() gave the ray
  const auto permute = [&](const Vec3<Real>& p) {
    return Vec3<Real>{select(x_first, p.y, select(y_first, p.z, p.x)), select(x_first, p.z, select(y_first, p.x, p.y)),
                      select(x_first, p.x, select(y_first, p.y, p.z))};
  };
  const Vec3<Real> way = permute(dir);
  const Shear<Real> shear{way.x / way.z, way.y / way.z, one / way.z};
  Vec3<Real> w{one, o, o};
  Real t(0);
  const Mask<Real> met = hit_triangle<Real>(permute(org), shear, Real(-kInfinity), permute(a), permute(b), permute(c), t, &w);
  w = select(met, w, Vec3<Real>{one, o, o});
  const Vec3<Real> e1 = b - a, e2 = c - a, point = a + (w.y * e1 + w.z * e2), n = across_both(e1, e2);
  Surface<Real> s{point, n, n, Real(16 * kEps) * (largest(e1) + largest(e2)) + Real(4 * kEps) * largest(point), words_at(g.triangle_material, i)};
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
