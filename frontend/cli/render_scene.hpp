#pragma once

#include "frontend/commands/commands.hpp"
#include "frontend/jobs/ranks.hpp"

namespace grelha {

/// Renders one scene, from its file to its picture. Returns the exit status.
int render_scene(const RenderCommand& command, Ranks& ranks);

}  // namespace grelha
