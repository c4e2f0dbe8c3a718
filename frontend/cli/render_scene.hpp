#pragma once

#include <string>
#include <utility>
#include <vector>

#include "frontend/commands/commands.hpp"
#include "frontend/files/atomic_file.hpp"
#include "frontend/jobs/ranks.hpp"

namespace grelha {

/// Checkpoints of scenes that are done, by name, and which files they are.
using Checkpoints = std::vector<std::pair<std::string, Location>>;

/// Renders one scene, from its file to its picture. Returns the exit status. A checkpoint that is
/// to stay until all scenes are done is appended to `left`.
int render_scene(const RenderCommand& command, Ranks& ranks, Checkpoints& left);

}  // namespace grelha
