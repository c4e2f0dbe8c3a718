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

struct Surface {
  Vec3<float> point, normal, shading;  ///< outward geometric normal, unit; shading normal, unit, same side
  float away;
  std::uint32_t material;
};

inline Surface plane_surface(const GeometryView& g, std::uint32_t i, const Vec3<float>& at) {
  const Vec3<float> p{g.px[i], g.py[i], g.pz[i]};
  const Vec3<float> n = normalize(Vec3<float>{g.pnx[i], g.pny[i], g.pnz[i]});
  Surface s;
  s.point = at - dot(at - p, n) * n;
  s.normal = s.shading = n;
  s.away = 8 * kEps * (largest(at) + largest(p));
  s.material = g.plane_material[i];
  return s;
}

inline Surface sphere_surface(const GeometryView& g, std::uint32_t i, const Vec3<float>& at) {
  const Vec3<float> c{g.sx[i], g.sy[i], g.sz[i]};
  const float r = magnitude(g.sr[i]);
  Surface s;
  s.normal = s.shading = normalize(at - c);
  s.point = c + r * s.normal;
  s.away = 16 * kEps * r + 4 * kEps * largest(s.point);
  s.material = g.sphere_material[i];
  return s;
}

inline Surface cone_surface(const GeometryView& g, std::uint32_t i, const Vec3<float>& at) {
  const Vec3<float> base{g.cone[0][i], g.cone[1][i], g.cone[2][i]}, axis{g.cone[3][i], g.cone[4][i], g.cone[5][i]};
  const float height = g.cone[6][i], radius = g.cone[7][i], slope = g.cone[8][i];
  const Vec3<float> from_base = at - base;
  float h = dot(from_base, axis);
  h = h < 0 ? 0 : h > height ? height : h;
  const Vec3<float> out = normalize(from_base - h * axis);
  Surface s;
  s.point = base + h * axis + (radius + slope * h) * out;
  s.normal = s.shading = normalize(out - slope * axis);
  s.away = 32 * kEps * (height + radius) + 4 * kEps * largest(s.point);
  s.material = g.cone_material[i];
  return s;
}

inline Surface triangle_surface(const GeometryView& g, std::uint32_t i, const float (&org)[3], const float (&dir)[3], bool smooth) {
  const std::uint32_t v[3] = {g.ta[i], g.tb[i], g.tc[i]};
  Vec3<float> c[3];
  for (int k = 0; k < 3; ++k) c[k] = {g.tx[v[k]], g.ty[v[k]], g.tz[v[k]]};
  const int k = shear_axis(dir[0], dir[1], dir[2]), kx = k == 2 ? 0 : k + 1, ky = k == 0 ? 2 : k - 1;
  const auto permute = [&](const Vec3<float>& p) {
    const float q[3] = {p.x, p.y, p.z};
    return Vec3<float>{q[kx], q[ky], q[k]};
  };
  const Shear<float> shear{dir[kx] / dir[k], dir[ky] / dir[k], 1 / dir[k]};
  Vec3<float> w{1, 0, 0};
  float t;
  hit_triangle<float>({org[kx], org[ky], org[k]}, shear, -kInfinity, permute(c[0]), permute(c[1]), permute(c[2]), t, &w);
  const Vec3<float> e1 = c[1] - c[0], e2 = c[2] - c[0];
  Surface s;
  s.point = c[0] + (w.y * e1 + w.z * e2);
  s.normal = normalize(cross(e1, e2));
  s.shading = s.normal;
  s.away = 16 * kEps * (largest(e1) + largest(e2)) + 4 * kEps * largest(s.point);
  s.material = g.triangle_material[i];
  if (!smooth) return s;
  Vec3<float> n[3];
  for (int j = 0; j < 3; ++j) {
    n[j] = {g.tnx[v[j]], g.tny[v[j]], g.tnz[v[j]]};
    const float nn = dot(n[j], n[j]);
    if (!(nn > 0)) return s;
    n[j] = (1 / square_root(nn)) * n[j];
  }
  const Vec3<float> mix = w.x * n[0] + (w.y * n[1] + w.z * n[2]);
  const float mm = dot(mix, mix);
  if (!(mm > 1e-12f)) return s;
  s.shading = (1 / square_root(mm)) * mix;
  if (dot(s.shading, s.normal) < 0) s.shading = Vec3<float>{0, 0, 0} - s.shading;
  return s;
}

inline Surface surface_of(const SceneView& scene, std::uint32_t id, const float (&org)[3], const float (&dir)[3], float t, bool smooth) {
  const GeometryView& g = scene.geometry;
  if (id >= scene.triangle_base && id < scene.cone_base) return triangle_surface(g, id - scene.triangle_base, org, dir, smooth);
  const Vec3<float> at{org[0] + t * dir[0], org[1] + t * dir[1], org[2] + t * dir[2]};
  if (id < scene.sphere_base) return plane_surface(g, id, at);
  if (id < scene.triangle_base) return sphere_surface(g, id - scene.sphere_base, at);
  return cone_surface(g, id - scene.cone_base, at);
}

/// Where a ray that leaves `point` on the side its direction points to must start. `normal` is unit.
inline Vec3<float> leave(const Vec3<float>& point, const Vec3<float>& normal, float away, const Vec3<float>& dir) {
  const float side = dot(dir, normal) < 0 ? 0 - away : away;
  return point + side * normal;
}

}  // namespace grelha::GRELHA_ISA
