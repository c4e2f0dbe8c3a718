#pragma once

#include <optional>

#include "frontend/commands/commands.hpp"
#include "frontend/images/image_file.hpp"
#include "frontend/jobs/ranks.hpp"

namespace grelha {

/// Renders one scene, from its file to its picture. Returns the exit status.
int render_scene(const RenderCommand& command, Ranks& ranks);

/// Throws UsageError when a picture of this size is too large for its format.
void check_image_size(std::optional<ImageFormat> format, int width, int height);

}  // namespace grelha
