#pragma once

#include "frontend/commands/commands.hpp"
#include "frontend/scene/frame.hpp"

namespace grelha {

/// What a pinhole camera's rays through the centres of pixels meet first; depths as the file's
/// lengths.
Layers first_hits(const World& world,
                  const Camera& camera,
                  const Frame& frame,
                  const LayerChoice& wanted);

}  // namespace grelha
