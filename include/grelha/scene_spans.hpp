#pragma once
// Non-owning views of a scene in the caller's own arrays, with the same members as Scene.

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "grelha/geometry.hpp"

namespace grelha {

using Floats = std::span<const float>;           ///< one component of all elements
using Indices = std::span<const std::uint32_t>;  ///< vertex or material indices

/// See Spheres.
struct SphereSpans {
  Floats x, y, z, radius;
  Indices material;
  SphereSpans() = default;
  /// Refers to the arrays of the argument.
  SphereSpans(const Spheres& s) : x(s.x), y(s.y), z(s.z), radius(s.radius), material(s.material) {}
  std::size_t size() const { return radius.size(); }  ///< number of elements
};

/// See Cones.
struct ConeSpans {
  Floats base_x, base_y, base_z, base_radius, apex_x, apex_y, apex_z, apex_radius;
  Indices material;
  ConeSpans() = default;
  /// Refers to the arrays of the argument.
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
  std::size_t size() const { return base_radius.size(); }  ///< number of elements
};

/// See Planes.
struct PlaneSpans {
  Floats x, y, z, nx, ny, nz;
  Indices material;
  PlaneSpans() = default;
  /// Refers to the arrays of the argument.
  PlaneSpans(const Planes& p)
      : x(p.x), y(p.y), z(p.z), nx(p.nx), ny(p.ny), nz(p.nz), material(p.material) {}
  std::size_t size() const { return x.size(); }  ///< number of elements
};

/// See Triangles.
struct TriangleSpans {
  Floats x, y, z;           ///< [vertices]
  Floats nx, ny, nz;        ///< [vertices], or empty when no vertex has a normal
  Floats red, green, blue;  ///< [vertices], or empty when no vertex has a colour
  Indices a, b, c, material;
  TriangleSpans() = default;
  /// Refers to the arrays of the argument.
  TriangleSpans(const Triangles& t)
      : x(t.x),
        y(t.y),
        z(t.z),
        nx(t.nx),
        ny(t.ny),
        nz(t.nz),
        red(t.red),
        green(t.green),
        blue(t.blue),
        a(t.a),
        b(t.b),
        c(t.c),
        material(t.material) {}
  std::size_t size() const { return a.size(); }          ///< number of elements
  std::size_t vertex_count() const { return x.size(); }  ///< number of vertices
};

/// See Geometry.
struct GeometrySpans {
  SphereSpans spheres;
  TriangleSpans triangles;
  ConeSpans cones;
  PlaneSpans planes;
  std::span<const Object> objects;
  GeometrySpans() = default;
  /// Refers to the arrays of the argument.
  GeometrySpans(const Geometry& g)
      : spheres(g.spheres),
        triangles(g.triangles),
        cones(g.cones),
        planes(g.planes),
        objects(g.objects) {}
};

/// See Scene. Constructed from a Scene, or filled in by a caller with arrays of its own. Arrays of
/// material indices may be empty, which means 0 for all. Without any materials there is a grey one.
struct SceneSpans {
  GeometrySpans geometry;
  std::span<const Material> materials;
  std::span<const Light> lights;
  Float3 background;
  SceneSpans() = default;  ///< empty
  /// Refers to the arrays of the argument.
  SceneSpans(const Scene& s)
      : geometry(s.geometry), materials(s.materials), lights(s.lights), background(s.background) {}
  SceneSpans(Scene&& gone) = delete;  ///< its arrays would be destroyed
};

/// Returns [materials] 1 for each material that a primitive uses, else 0. All material indices must
/// be in range.
inline std::vector<char> used_materials(const SceneSpans& scene) {
  std::vector<char> used(scene.materials.size());
  std::size_t unused = used.size();
  const GeometrySpans& g = scene.geometry;
  for (const Indices& ids :
       {g.spheres.material, g.triangles.material, g.cones.material, g.planes.material})
    for (const std::uint32_t i : ids)
      if (!std::exchange(used[i], 1) && --unused == 0)
        return used;
  return used;
}

}  // namespace grelha
