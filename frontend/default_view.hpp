#pragma once

#include "frontend/scene_file.hpp"

namespace grelha {

/// For a mesh alone, whose file knows neither camera nor light: frames the triangles from a three-quarter view with y
/// up, puts a light above the camera's left shoulder, a soft background behind.
void add_default_view(SceneFile& file);

/// Light grey with a mild highlight.
Material default_mesh_material();

}  // namespace grelha
