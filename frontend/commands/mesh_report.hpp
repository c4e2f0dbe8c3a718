#pragma once
// Tells whether a file's mesh is closed, oriented and manifold, for `grelha info`.

#include <string>

#include "frontend/commands/json.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// A line, or two: closed or where it is open, and other defects.
std::string mesh_text(const SceneFile& file);
Json mesh_json(const SceneFile& file);

}  // namespace grelha
