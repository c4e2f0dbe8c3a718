#pragma once

#include "frontend/commands/commands.hpp"

namespace grelha {

/// What a pinhole camera's rays through the centres of pixels meet first.
Layers first_hits(const World& world, const Camera& camera, const LayerChoice& wanted);

}  // namespace grelha
