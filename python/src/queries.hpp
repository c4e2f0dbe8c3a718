#pragma once
// The queries of World's methods. One ray or point gives plain numbers, many give arrays.

#include "src/model.hpp"
#include "src/ray_batch.hpp"

namespace grelha::python {

py::object closest_hits(const Model& model, const RayArguments& rays, py::handle threads);
py::object occluded_rays(const Model& model, const RayArguments& rays, py::handle threads);
py::object all_ray_hits(const Model& model, const RayArguments& rays, py::handle threads);
py::object ray_crossings(const Model& model, const RayArguments& rays, py::handle threads);
py::object crossing_counts(const Model& model, const RayArguments& rays, py::handle threads);
py::object hit_counts(const Model& model, const RayArguments& rays, py::handle threads);
/// Points, normals, colours and ids of what rays hit first.
py::object ray_surfaces(const Model& model, const RayArguments& rays, py::handle threads);

/// Where rays start on faces.
struct StartArguments {
  py::handle face, u, v, directions;
};
py::object start_points(const Model& model, const StartArguments& given);

py::object inside_points(const SharedModel& model,
                         py::handle points,
                         py::handle rule,
                         py::handle threads);
py::object nearest_points(const SharedModel& model,
                          py::handle points,
                          py::handle radius,
                          py::handle threads);
py::object signed_distances_of(const SharedModel& model,
                               py::handle points,
                               py::handle rule,
                               py::handle threads);
py::object winding_numbers_of(const SharedModel& model,
                              py::handle points,
                              py::handle error,
                              py::handle threads);

/// What the triangles are as a mesh.
py::object checked_mesh(const SharedModel& model);

/// A class of grelha/_results.py.
py::object result_class(const char* name);

/// An array's only number, or the array.
template <class T>
py::object plain(const py::array_t<T>& array, const Shape& shape) {
  return shape.empty() ? py::cast(*array.data()) : py::object(array);
}

}  // namespace grelha::python
