#pragma once

#include "frontend/scene/scene_file.hpp"
#include "tests/fuzz/target.hpp"

namespace grelha::fuzz {

/// Computes the digest of the scene, builds its grids and renders 8 x 8 pixels with randomly chosen
/// options. If the scene is small, a second render, one ray at a time against every primitive, must
/// give the same bits. Large scenes are skipped.
void render_small(SceneFile file, Choices choices);

}  // namespace grelha::fuzz
