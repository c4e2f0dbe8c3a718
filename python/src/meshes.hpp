#pragma once
// Several meshes in one Model.

#include "grelha/meshes.hpp"
#include "src/model.hpp"

namespace grelha::python {

/// Meshes whose arrays were joined. `counts`, (meshes, 2): the vertices and faces of each.
ModelParts joined_parts(py::handle vertices, py::handle faces, py::handle counts);
/// The same model where some meshes have other vertices, as many, in the frame of before: pairs of
/// mesh and vertices. Throws TypeError and ValueError that name the argument, or the method.
SharedModel meshes_moved(const Model& before,
                         const py::list& moves,
                         const char* method,
                         int threads);

/// The same model where one mesh is hidden, or shown again.
SharedModel mesh_shown(const Model& before, py::handle mesh, bool visible, int threads);
/// The same model with a mesh more, in the frame of before.
SharedModel mesh_added(const Model& before, py::handle vertices, py::handle faces, int threads);
/// The same model without a mesh.
SharedModel mesh_removed(const Model& before, py::handle mesh, int threads);

bool mesh_is_visible(const Model& model, py::handle mesh);
/// The mesh of each primitive, and its row among the mesh's faces; -1 and -1 for what is no face.
py::tuple mesh_of(const Model& model, py::handle ids);

}  // namespace grelha::python
