#pragma once

#include <utility>
#include <vector>

#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// The features of a renderer by name, and whether the scene uses them. Materials that no primitive
/// has do not count.
using Needs = std::vector<std::pair<const char*, bool>>;

Needs needs_of(const SceneFile& file);

}  // namespace grelha
