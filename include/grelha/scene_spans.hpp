#pragma once
// A scene in the caller's own arrays. It has the members of Scene and owns
// nothing.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "grelha/geometry.hpp"

namespace grelha {

using Floats = std::span<const float>;           ///< one component of many
using Indices = std::span<const std::uint32_t>;  ///< vertices or materials of many

/// See Spheres.
struct SphereSpans {
  Floats x, y, z, radius;
  Indices material;
  SphereSpans() = default;
  /// Spans of what it holds.
  SphereSpans(const Spheres& s) : x(s.x), y(s.y), z(s.z), radius(s.radius), material(s.material) {}
  std::size_t size() const { return radius.size(); }  ///< how many
};

/// See Cones.
struct ConeSpans {
  Floats base_x, base_y, base_z, base_radius, apex_x, apex_y, apex_z, apex_radius;
  Indices material;
  ConeSpans() = default;
  /// Spans of what it holds.
  ConeSpans(const Cones& c)
      : base_x(c.base_x),
        base_y(c.base_y),
        base_z(c.base_z),
        base_radius(c.base_radius),
        apex_x(c.apex_x),
        apex_y(c.apex_y),
        apex_z(c.apex_z),
        apex_radius(c.apex_radius),
        material(c.material) {}
  std::size_t size() const { return material.size(); }  ///< how many
};

/// See Planes.
struct PlaneSpans {
  Floats x, y, z, nx, ny, nz;
  Indices material;
  PlaneSpans() = default;
  /// Spans of what it holds.
  PlaneSpans(const Planes& p)
      : x(p.x), y(p.y), z(p.z), nx(p.nx), ny(p.ny), nz(p.nz), material(p.material) {}
  std::size_t size() const { return material.size(); }  ///< how many
};

/// See Triangles.
struct TriangleSpans {
  Floats x, y, z;     ///< [vertices]
  Floats nx, ny, nz;  ///< [vertices], or empty when no vertex has a normal
  Indices a, b, c, material;
  TriangleSpans() = default;
  /// Spans of what it holds.
  TriangleSpans(const Triangles& t)
      : x(t.x),
        y(t.y),
        z(t.z),
        nx(t.nx),
        ny(t.ny),
        nz(t.nz),
        a(t.a),
        b(t.b),
        c(t.c),
        material(t.material) {}
  std::size_t size() const { return a.size(); }          ///< how many
  std::size_t vertex_count() const { return x.size(); }  ///< how many corners they share
};

/// See Geometry.
struct GeometrySpans {
  SphereSpans spheres;
  TriangleSpans triangles;
  ConeSpans cones;
  PlaneSpans planes;
  std::span<const Object> objects;
  GeometrySpans() = default;
  /// Spans of what it holds.
  GeometrySpans(const Geometry& g)
      : spheres(g.spheres),
        triangles(g.triangles),
        cones(g.cones),
        planes(g.planes),
        objects(g.objects) {}
};

/// See Scene; made from one, or filled in by a caller that keeps its arrays itself.
struct SceneSpans {
  GeometrySpans geometry;
  std::span<const Material> materials;
  std::span<const Light> lights;
  Float3 background;
  SceneSpans() = default;  ///< empty
  /// Spans of what it holds.
  SceneSpans(const Scene& s)
      : geometry(s.geometry), materials(s.materials), lights(s.lights), background(s.background) {}
  SceneSpans(Scene&& gone) = delete;  ///< its arrays would be gone as well
};

/// [materials] 1 where some primitive has it, 0 elsewhere. Primitives name materials that exist.
inline std::vector<char> used_materials(const SceneSpans& scene) {
  std::vector<char> used(scene.materials.size());
  const GeometrySpans& g = scene.geometry;
  for (const Indices& ids :
       {g.spheres.material, g.triangles.material, g.cones.material, g.planes.material})
    for (const std::uint32_t i : ids)
      used[i] = 1;
  return used;
}

}  // namespace grelha
