#pragma once

#include <string>

#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// Reads .nff, .p3f, .ply or .stl, each also with .gz behind it (told apart by the extension; gzip
/// by its first bytes). Throws ParseError (wrong content) or FileError (cannot be read).
SceneFile read_scene(const std::string& path, const Warn& warn, const ReadOptions& options = {});

}  // namespace grelha
