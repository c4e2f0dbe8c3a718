#pragma once

#include <optional>

#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// Returns a more precise frame for a scene that was read in the file's own frame, if there is one.
std::optional<Frame> find_frame(const SceneFile& file);

/// Returns true if the file's own frame loses precision: a coordinate read in `file.frame` is not a
/// float there.
bool needs_frame(const SceneFile& file);

}  // namespace grelha
