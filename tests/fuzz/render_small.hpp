#pragma once

#include "frontend/scene/scene_file.hpp"
#include "tests/fuzz/target.hpp"

namespace grelha::fuzz {

/// Says what the scene holds, builds its grids and renders 8 x 8 pixels of it, in one of the many
/// ways to do so. Where that is no long work a second way, one ray at a time against every
/// primitive, must come to the same bits. Large scenes are left alone.
void render_small(SceneFile file, Choices choices);

}  // namespace grelha::fuzz
