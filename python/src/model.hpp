#pragma once
// A World with the arrays that it refers to.

#include <cstdint>
#include <memory>

#include "frontend/scene/frame.hpp"
#include "grelha/geometry.hpp"
#include "grelha/world.hpp"
#include "src/arrays.hpp"

namespace grelha::python {

/// Immutable once it is built, so queries on several threads may share it.
struct Model {
  Scene scene;
  Frame frame;             ///< in which the scene lies
  bool in_double = false;  ///< points are given back in double
  std::unique_ptr<World> world;

  std::uint32_t first_triangle() const {  ///< the id of face 0
    return std::uint32_t(scene.geometry.planes.size() + scene.geometry.spheres.size());
  }
  std::uint32_t primitives() const {
    const Geometry& g = scene.geometry;
    return first_triangle() + std::uint32_t(g.triangles.size() + g.cones.size());
  }
  bool is_one_mesh() const { return primitives() == scene.geometry.triangles.size(); }
};
using SharedModel = std::shared_ptr<const Model>;

/// Builds the grids, while signals are heard.
SharedModel built(std::shared_ptr<Model> model, int threads);

/// A model of triangles, not built yet. Throws TypeError and ValueError that name the argument.
std::shared_ptr<Model> mesh_model(py::handle vertices, py::handle faces);
/// The same faces with other vertices, as many; or spheres with other centers, as many, and radii.
std::shared_ptr<Model> moved_model(const Model& model, py::handle vertices, py::handle radii);
/// A model of spheres.
std::shared_ptr<Model> sphere_model(py::handle centers, py::handle radii);

/// Points of the model's frame in the caller's units: (..., 3), float64 if the vertices were.
py::object outside_points(const Model& model, const std::vector<Float3>& points, Shape shape);
/// Masks of the primitives as uint8 (primitives,). Throws TypeError and ValueError.
py::array_t<std::uint8_t> masks_in(py::handle given, const Model& model);

}  // namespace grelha::python
