#pragma once

#include "frontend/files/text.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// Determines the order of the six numbers of every `aabb` in a file. Two orders are in use, and
/// only the numbers tell them apart. The numbers of one box often allow both, so this reads all
/// boxes of the file.
///
/// Pairs have every minimum before its maximum; corners ascend, or descend, on every axis. Pairs
/// when all boxes are in pairs and some cannot be corners; corners otherwise, which any six numbers
/// can be. `words` stands behind the first `aabb` and is left there.
BoxOrder aabb_order(Words words);

}  // namespace grelha
