#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "frontend/scene/mesh.hpp"
#include "frontend/scene/polygon.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// Returns a normal whose square fits a float; (0,0,0), "none", if it has no direction.
Float3 valid_normal(const Float3& n);

/// Faces of a mesh whose outlines cross themselves: those that are filled by the even-odd rule, and
/// those that do so too often; and those that fold over themselves (PolygonSplitter::Result).
struct CrossedFaces {
  std::uint64_t filled = 0, left_out = 0, folded = 0;
  std::uint64_t first = 0, first_folded = 0;  ///< number of the first one, from 0
  void add(PolygonSplitter::Result result, std::uint64_t face);
  /// Adds those of a mesh behind `faces` faces.
  void add(const CrossedFaces& more, std::uint64_t faces);
  /// The text of a warning; empty if there are no such faces.
  std::string text() const;
};

/// Gives each colour of faces, or of points, a material: `of` with diffuse and emission times the
/// colour. Returns those of all. `of` follows again, for it may be the one in use.
std::vector<std::uint32_t> materials_of_colors(const Mesh& mesh,
                                               std::vector<Material>& all,
                                               std::uint32_t of);

/// Adds the primitives of the readers to the kernel's arrays. Primitives that cannot be drawn are
/// counted in SceneFile::dropped instead.
class SceneBuilder {
 public:
  explicit SceneBuilder(SceneFile& file, const MeshOptions& options = {})
      : file_(file), options_(options) {}

  void sphere(Float3 center, float radius, std::uint32_t material);
  void cone(Float3 base, float base_radius, Float3 apex, float apex_radius, std::uint32_t material);
  /// Through three points, front where they run counter-clockwise.
  void plane(Float3 a, Float3 b, Float3 c, std::uint32_t material);
  /// The points q with normal . q = distance.
  void plane(Float3 normal, float distance, std::uint32_t material);
  using Result = PolygonSplitter::Result;
  /// `normals`: one per corner, or empty. `report` is called of an outline that crosses itself
  /// or folds over itself, before anything is added; it may throw.
  void polygon(std::span<const Float3> corner_points,
               std::span<const Float3> normals,
               std::uint32_t material,
               const std::function<void(Result)>& report = {});
  /// Any two opposite corners. A box without thickness along one axis is drawn as its two large
  /// faces.
  void box(Float3 corner, Float3 opposite, std::uint32_t material);
  /// Becomes an object of its own, or its solids do.
  CrossedFaces mesh(Mesh mesh, std::uint32_t material);

 private:
  /// Counts a primitive without area, and where it would have been.
  void drop_flat(std::initializer_list<Float3> corner_points);
  void drop_flat(std::span<const Float3> corner_points);
  std::uint32_t add_vertex(Float3 point, Float3 normal, Float3 color = {1, 1, 1});
  Float3 point(std::uint32_t vertex) const;
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t material);
  /// Returns whether anything is left of the triangle's area in floats.
  bool has_area(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
  void triangle(std::span<const Float3> corner_points,
                std::span<const Float3> normals,
                std::uint32_t material);
  void with_intersections(std::span<const Float3>& of_corners, std::vector<Float3>& all);
  bool is_nonplanar(std::span<const Float3> corner_points) const;
  void mesh_triangles(std::span<const std::uint32_t> corner_points,
                      std::uint32_t first_vertex,
                      std::uint32_t material);
  CrossedFaces mesh_faces(const Mesh& mesh,
                          const std::vector<bool>& bad,
                          std::uint32_t first_vertex,
                          std::uint32_t material,
                          std::span<const std::uint32_t> materials);
  std::vector<std::uint32_t> materials_of(const Mesh& mesh, std::size_t count, std::uint32_t of);
  void points(const Mesh& mesh, std::uint32_t material);
  CrossedFaces object(Mesh mesh, std::uint32_t material, bool smooth);
  void smooth_solids(std::span<NamedObject> solids);
  Result mesh_face(std::span<const std::uint32_t> corner_points,
                   std::uint32_t first_vertex,
                   std::uint32_t material);
  void add_intersections();
  void append_vertices(Mesh& mesh);
  std::vector<Float3> at_corners(const std::vector<float>& x,
                                 const std::vector<float>& y,
                                 const std::vector<float>& z) const;

  SceneFile& file_;
  const MeshOptions options_;
  PolygonSplitter splitter_;
  std::vector<PolygonSplitter::Triangle> triangles_;
  std::vector<Float3> face_, all_points_, all_normals_;
  std::vector<std::uint32_t> face_vertices_;
};

}  // namespace grelha
