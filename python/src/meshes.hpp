#pragma once
// Several meshes in one Model.

#include "src/model.hpp"

namespace grelha::python {

/// Meshes whose arrays were joined. `counts`, (meshes, 2): the vertices and faces of each.
ModelParts joined_parts(py::handle vertices, py::handle faces, py::handle counts);
/// The same model where one mesh has other vertices, as many, in the frame of before. Throws
/// TypeError and ValueError that name the argument.
SharedModel mesh_moved(const Model& before, py::handle mesh, py::handle vertices, int threads);

std::size_t mesh_count(const Model& model);
/// The mesh of each primitive, and its row among the mesh's faces; -1 and -1 for what is no face.
py::tuple mesh_of(const Model& model, py::handle ids);

}  // namespace grelha::python
