#pragma once
// Colours and materials as callers give them.

#include <array>
#include <vector>

#include "frontend/scene/scene_file.hpp"
#include "src/arrays.hpp"

namespace grelha::python {

/// Light of at least 0. Throws ValueError that names the argument.
Float3 color_of(const std::array<double, 3>& color, const char* name);
/// Three numbers, or one for all.
Float3 color_in(py::handle given, const std::string& name);

/// Gives a mesh colours, (vertices, 3) or (faces, 3): bytes are sRGB, other numbers light from 0 to
/// 1. Those of faces become materials like its one. Returns whether they are of vertices. Throws
/// TypeError or ValueError.
bool put_colors(py::handle given, Scene& scene);

/// Degrees, or 0 for None.
double smoothness_in(py::handle given);

/// What read() makes of meshes: `points` is a radius, "auto" or None, `smooth` degrees or None.
MeshOptions meshes_in(bool colors, py::handle points, py::handle smooth);

/// Changes the materials of a mesh by a dict of their fields. Those of faces with colours keep
/// their diffuse. Throws TypeError or ValueError that names the field.
void put_material(py::handle given, std::vector<Material>& materials);

}  // namespace grelha::python
