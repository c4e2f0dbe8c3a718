#pragma once

#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// Adds a camera and lights to the scene of a bare mesh, whose file has neither. The camera frames
/// the triangles from a three-quarter view, with y up, or z where the mesh surely stands on that
/// side. A key light stands above the left shoulder, a fill at the eye, so that no face it sees is
/// black, and one light behind. The background is
/// soft.
void add_default_view(SceneFile& file);

/// Light grey with a mild highlight; of a mesh with colours white with less of one, for these to
/// show as they are.
Material default_mesh_material(bool has_colors = false);

}  // namespace grelha
