#pragma once
// Several meshes in one Model.

#include "grelha/meshes.hpp"
#include "src/model.hpp"

namespace grelha::python {

/// Meshes whose arrays were joined. `counts`, (meshes, 2): the vertices and faces of each.
ModelParts joined_parts(py::handle vertices, py::handle faces, py::handle counts);
/// A model where some meshes have other vertices, as many, in the frame of before: pairs of mesh
/// and vertices. It is `before` itself, changed, where nobody shares it and little is built, else a
/// copy. Throws TypeError and ValueError that name the argument, or the method.
SharedModel meshes_moved(const SharedModel& before,
                         const py::list& moves,
                         const char* method,
                         int threads);

/// The same where one mesh is hidden, or shown again.
SharedModel mesh_shown(const SharedModel& before, py::handle mesh, bool visible, int threads);
/// The same with a mesh more, in the frame of before.
SharedModel mesh_added(const SharedModel& before,
                       py::handle vertices,
                       py::handle faces,
                       int threads);
/// A copy without a mesh.
SharedModel mesh_removed(const Model& before, py::handle mesh, int threads);

bool mesh_is_visible(const Model& model, py::handle mesh);
/// The mesh of each primitive, and its row among the mesh's faces; -1 and -1 for what is no face.
py::tuple mesh_of(const Model& model, py::handle ids);

}  // namespace grelha::python
