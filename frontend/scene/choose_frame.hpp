#pragma once

#include <optional>

#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// The frame for a scene that was read in the file's own, if another one keeps more of it.
std::optional<Frame> better_frame(const SceneFile& file);

/// Whether the file's own frame loses something: a coordinate read in `file.frame` is no float
/// there.
bool needs_its_frame(const SceneFile& file);

}  // namespace grelha
