#pragma once
// Geometry as plain arrays that the caller fills in: one array per component, separate arrays for
// each kind of primitive. The kernel only reads them. All lengths are in scene units.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace grelha {

/// A point, a direction or a linear RGB colour.
struct Float3 {
  float x = 0, y = 0, z = 0;
  bool operator==(const Float3&) const = default;  ///< component by component
  /// Adds component by component.
  friend Float3 operator+(Float3 a, Float3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  /// Subtracts component by component.
  friend Float3 operator-(Float3 a, Float3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  /// Multiplies each component.
  friend Float3 operator*(float s, Float3 a) { return {s * a.x, s * a.y, s * a.z}; }
};
/// Returns the scalar product.
inline float dot(Float3 a, Float3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
/// Returns the vector product.
inline Float3 cross(Float3 a, Float3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Returns a vector of length 1 in the same direction; NaN for (0, 0, 0).
inline Float3 normalized(Float3 a) {
  return 1 / std::sqrt(dot(a, a)) * a;
}

/// Spheres. With a negative radius only the inside is visible (NFF).
struct Spheres {
  std::vector<float> x, y, z, radius;                 ///< [count]
  std::vector<std::uint32_t> material;                ///< [count] index into Scene::materials
  std::size_t size() const { return radius.size(); }  ///< number of elements
  /// Appends one primitive with material index `m`.
  void add(Float3 center, float r, std::uint32_t m) {
    x.push_back(center.x);
    y.push_back(center.y);
    z.push_back(center.z);
    radius.push_back(r);
    material.push_back(m);
  }
};

/// Sides of cone frusta without end caps; equal radii make cylinders. If both radii are negative,
/// only the inside is visible.
struct Cones {
  std::vector<float> base_x, base_y, base_z, base_radius;  ///< [count]
  std::vector<float> apex_x, apex_y, apex_z, apex_radius;  ///< [count]
  std::vector<std::uint32_t> material;                     ///< [count]
  std::size_t size() const { return material.size(); }     ///< number of elements
  /// Appends one primitive with material index `m`.
  void add(Float3 base, float rb, Float3 apex, float ra, std::uint32_t m) {
    base_x.push_back(base.x);
    base_y.push_back(base.y);
    base_z.push_back(base.z);
    base_radius.push_back(rb);
    apex_x.push_back(apex.x);
    apex_y.push_back(apex.y);
    apex_z.push_back(apex.z);
    apex_radius.push_back(ra);
    material.push_back(m);
  }
};

/// Infinite planes through a point; the normal need not have unit length.
struct Planes {
  std::vector<float> x, y, z;     ///< [count] a point of the plane
  std::vector<float> nx, ny, nz;  ///< [count] normal
  std::vector<std::uint32_t> material;
  std::size_t size() const { return material.size(); }  ///< number of elements
  /// Appends a plane through `p` with normal `n` and material index `m`.
  void add(Float3 p, Float3 n, std::uint32_t m) {
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
    nx.push_back(n.x);
    ny.push_back(n.y);
    nz.push_back(n.z);
    material.push_back(m);
  }
};

/// Indexed triangles of all meshes and polygons. Two triangles that share an edge are watertight
/// along it if the coordinates of its vertices are equal; the indices may differ.
struct Triangles {
  std::vector<float> x, y, z;  ///< [vertices]
  /// [vertices] normals of any length, or empty if no vertex has one; (0,0,0): this vertex has none
  std::vector<float> nx, ny, nz;
  /// [vertices] linear light from 0 to 1 that multiplies diffuse and emission of the material,
  /// mixed by u and v between the vertices; or empty: 1 everywhere
  std::vector<float> red, green, blue;
  /// [count] vertices of each triangle, counter-clockwise from the front
  std::vector<std::uint32_t> a, b, c;
  std::vector<std::uint32_t> material;                   ///< [count]
  std::size_t size() const { return a.size(); }          ///< number of elements
  std::size_t vertex_count() const { return x.size(); }  ///< number of vertices
};

/// A range of triangles that form one object (a PLY file, an inline mesh) and get their own grid.
struct Object {
  std::uint32_t first_triangle = 0, triangle_count = 0;
  bool visible = true;  ///< false: its triangles keep their ids, and no query finds them
};

/// All primitives of a scene. Primitive ids count planes first, then spheres, triangles and cones,
/// each kind in the order of its arrays.
struct Geometry {
  Spheres spheres;
  Triangles triangles;
  Cones cones;
  Planes planes;
  /// disjoint, in ascending order; triangles outside all objects share one grid with the spheres
  /// and cones
  std::vector<Object> objects;
};

/// The kinds of primitives, in the order of their ids.
enum class PrimitiveKind { kPlane, kSphere, kTriangle, kCone };

/// A primitive, named by its kind and its index in the caller's arrays.
struct Primitive {
  PrimitiveKind kind;
  std::uint32_t index;  ///< into the caller's arrays of this kind
};

/// How a surface reflects, transmits and emits light. Every weight is the final product (Kd times
/// colour and so on).
struct Material {
  Float3 diffuse{};   ///< weight of the Lambert term
  Float3 specular{};  ///< weight of the Blinn-Phong highlight
  /// weight of the reflected ray; with `fresnel` the weight comes from Schlick's formula
  Float3 mirror{};
  float transmission = 0;  ///< weight of the refracted ray; 0: opaque
  float shine = 0;         ///< exponent of the highlight
  /// index of refraction of the inside against 1 outside; read only when transmission > 0
  float ior = 1;
  /// split between mirror and refraction by Schlick (1994) where transmission > 0
  bool fresnel = false;
  Float3 emission{};  ///< light given off, as Triangles::red and its like tint it
  /// spread of the mirror lobe: radius of a disc across the unit mirror direction at its tip
  float roughness = 0;
  bool operator==(const Material&) const = default;  ///< field by field
};

/// A point light, or an area light in the shape of a parallelogram. Each shadow ray goes to one
/// point of the light, and a surface receives the mean over these points. With both edges zero it
/// is a point light.
struct Light {
  Float3 position{}, color{};  ///< position: the centre
  Float3 edge1{}, edge2{};     ///< full edges
  /// Returns true for an area light: an edge is not zero.
  bool is_area() const { return edge1 != Float3{} || edge2 != Float3{}; }
};

/// A scene, from which a World is built.
struct Scene {
  Geometry geometry;
  std::vector<Material> materials;
  std::vector<Light> lights;
  Float3 background;  ///< radiance of rays that hit nothing
};

}  // namespace grelha
