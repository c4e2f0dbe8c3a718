#pragma once

#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// For a mesh alone, whose file knows neither camera nor light: frames the triangles from a
/// three-quarter view, with y up, or z where it surely stands on that side; a key light above the
/// left shoulder, a fill from the eye, so that no face it sees is black, one from behind, and a
/// soft background.
void add_default_view(SceneFile& file);

/// Light grey with a mild highlight.
Material default_mesh_material();

}  // namespace grelha
