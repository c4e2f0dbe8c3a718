#pragma once

#include <string>
#include <string_view>

#include "frontend/scene/scene_file.hpp"

namespace grelha {

class LoadProgress;

/// Reads NFF and the dialects built on it (the entities of docs/nff.md) as a stream of words. The
/// line end matters only behind `l`, `f`, `mat`, `al` and to comments. Files named by `ply` are
/// looked for beside `path`.
SceneFile read_nff(const std::string& path,
                   std::string_view text,
                   const Warn& warn,
                   const ReadOptions& options = {},
                   LoadProgress* progress = nullptr);

}  // namespace grelha
