#pragma once

#include "frontend/commands/commands.hpp"
#include "frontend/scene/frame.hpp"

namespace grelha {

/// Finds the first hits of a pinhole camera's rays through the pixel centres. Depths are in the
/// file's units.
Layers first_hits(const World& world,
                  const Camera& camera,
                  const Frame& frame,
                  const LayerChoice& wanted);

}  // namespace grelha
