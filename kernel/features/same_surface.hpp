#pragma once
// Which primitives pass for one surface, and which are pieces of one mesh.

#include "kernel/features/beam.hpp"
#include "kernel/features/corner_hits.hpp"
#include "kernel/scene/shading_view.hpp"

namespace grelha::GRELHA_ISA {

inline bool is_triangle(const GeometryView& g, std::uint32_t id) {
  return g.ids.has(PrimitiveKind::kTriangle, id);
}
/// Which triangle an id is.
inline std::uint32_t triangle_of(const GeometryView& g, std::uint32_t id) {
  return id - g.ids.begin(PrimitiveKind::kTriangle);
}
inline Corners3 corners_of(const GeometryView& g, std::uint32_t id) {
  return triangle_corners(g.of<Triangle>(), triangle_of(g, id));
}
inline std::uint32_t material_of(const GeometryView& g, std::uint32_t id) {
  return g.of<Triangle>().material[triangle_of(g, id)];
}

/// Material of a primitive of any kind.
inline std::uint32_t material_of_any(const GeometryView& g, std::uint32_t id) {
  return visit_shape(
      Shapes{}, g.ids, id, [&]<class Shape>(std::uint32_t i) __attribute__((always_inline)) {
        return g.of<Shape>().material[i];
      });
}
inline Vec3f material_color(const MaterialView& materials, std::uint32_t m, MaterialField red) {
  return {materials.field[red][m], materials.field[red + 1][m], materials.field[red + 2][m]};
}

inline bool same(const Vec3f& a, const Vec3f& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}
inline bool has(const Corners3& t, const Vec3f& p) {
  return same(t.at[0], p) || same(t.at[1], p) || same(t.at[2], p);
}

/// Triangles of one material: pieces of one mesh, most likely.
inline bool kin(const GeometryView& g, std::uint32_t a, std::uint32_t b) {
  return is_triangle(g, a) && is_triangle(g, b) && material_of(g, a) == material_of(g, b);
}

/// Whether two primitives pass for one surface: triangles of one material that face nearly one way.
/// Where one hides the other and both are lit alike, nobody can tell.
inline bool alike(const GeometryView& g,
                  std::uint32_t a,
                  std::uint32_t b,
                  float cosine_squared = kOneSurfaceSquared) {
  if (a == b)
    return true;
  if (!kin(g, a, b))
    return false;
  const auto flat_normal = [&](std::uint32_t id) {
    const Corners3 c = corners_of(g, id);
    return cross(c.at[1] - c.at[0], c.at[2] - c.at[0]);
  };
  const Vec3f n = flat_normal(a);
  const Vec3f m = flat_normal(b);
  const float d = dot(n, m);
  return d * d > cosine_squared * (dot(n, n) * dot(m, m));
}

inline bool one_surface(const GeometryView& g, const std::uint32_t (&id)[kCorners]) {
  return alike(g, id[0], id[1]) && alike(g, id[0], id[2]) && alike(g, id[0], id[3]);
}

/// Whether two triangles share a corner; other primitives touch themselves alone.
inline bool touch(const GeometryView& g, std::uint32_t a, std::uint32_t b) {
  if (!is_triangle(g, a) || !is_triangle(g, b))
    return a == b;
  const Corners3 p = corners_of(g, a);
  const Corners3 q = corners_of(g, b);
  return has(p, q.at[0]) || has(p, q.at[1]) || has(p, q.at[2]);
}

}  // namespace grelha::GRELHA_ISA
