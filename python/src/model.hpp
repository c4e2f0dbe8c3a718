#pragma once
// A World with its arrays, and the frame in which callers see it.

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "frontend/scene/scene_file.hpp"
#include "grelha/owning_world.hpp"
#include "src/arrays.hpp"

namespace grelha::python {

/// What a Model is built of.
struct ModelParts {
  OffsetScene scene{};
  double scale = 1;        ///< of the frame in which the scene lies
  bool in_double = false;  ///< points are given back in double
};

/// It does not change while it is shared, so queries on several threads may share it.
struct Model {
  OwningWorld owner;
  Frame frame;  ///< in which the scene lies
  bool in_double;

  /// Shares grids with a model `before`, unless it is null, of which some triangles moved.
  Model(ModelParts parts,
        const BuildOptions& options,
        const Model* before,
        std::span<const Object> moved)
      : owner(before ? OwningWorld(std::move(parts.scene), options, before->owner, moved)
                     : OwningWorld(std::move(parts.scene), options)),
        frame{scene().offset, parts.scale},
        in_double(parts.in_double) {}
  const World& world() const { return owner.world(); }
  const OffsetScene& scene() const { return owner.scene(); }
  const Geometry& geometry() const { return scene().geometry; }
  std::uint32_t first_triangle() const {  ///< the id of face 0
    return std::uint32_t(geometry().planes.size() + geometry().spheres.size());
  }
  std::uint32_t primitives() const {
    return first_triangle() + std::uint32_t(geometry().triangles.size() + geometry().cones.size());
  }
  bool is_one_mesh() const { return primitives() == geometry().triangles.size(); }
};
using SharedModel = std::shared_ptr<const Model>;

/// Builds the grids, while signals are heard; those that a Model before has are shared.
SharedModel built(ModelParts parts,
                  int threads,
                  const Model* before = nullptr,
                  std::span<const Object> moved = {});

/// Vertices of shape (n, 3). Throws TypeError and ValueError.
Triples vertices_in(py::handle given);
/// Shapes at points. Throws ValueError for points that no scene can have.
ModelParts parts_of(const Triples& points, Geometry shapes);
/// Triangles, not built yet. Throws TypeError and ValueError that name the argument.
ModelParts mesh_parts(py::handle vertices, py::handle faces);
/// The same faces with other vertices, as many; or spheres with other centers, as many, and radii.
ModelParts moved_parts(const Model& model, py::handle vertices, py::handle radii);
/// Spheres.
ModelParts sphere_parts(py::handle centers, py::handle radii);

/// Points of the model's frame in the caller's units: (..., 3), float64 if the vertices were.
py::object outside_points(const Model& model, const std::vector<Float3>& points, Shape shape);
/// Triples as they are: (..., 3) float32.
py::array_t<float> floats_of(const std::vector<Float3>& all, Shape shape);
/// Masks of the primitives as uint8 (primitives,). Throws TypeError and ValueError.
py::array_t<std::uint8_t> masks_in(py::handle given, const Model& model);

}  // namespace grelha::python
