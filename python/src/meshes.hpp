#pragma once
// Several meshes in one Model.

#include "grelha/meshes.hpp"
#include "src/model.hpp"

namespace grelha::python {

/// Meshes whose arrays were joined. `counts`, (meshes, 2): the vertices and faces of each.
ModelParts joined_parts(py::handle vertices, py::handle faces, py::handle counts);
/// The same model where one mesh has other vertices, as many, in the frame of before. Throws
/// TypeError and ValueError that name the argument.
SharedModel mesh_moved(const Model& before, py::handle mesh, py::handle vertices, int threads);

/// The same model where one mesh is hidden, or shown again.
SharedModel mesh_shown(const Model& before, py::handle mesh, bool visible, int threads);
/// The same model with a mesh more, in the frame of before.
SharedModel mesh_added(const Model& before, py::handle vertices, py::handle faces, int threads);

bool mesh_is_visible(const Model& model, py::handle mesh);
/// The mesh of each primitive, and its row among the mesh's faces; -1 and -1 for what is no face.
py::tuple mesh_of(const Model& model, py::handle ids);

}  // namespace grelha::python
