#pragma once

#include "frontend/files/text.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// What the six numbers of every `aabb` in a file are. Two orders are about, and only the numbers
/// tell them apart: those of one box often allow both, so all boxes of the file are asked.
///
/// Pairs have every minimum before its maximum; corners ascend, or descend, on every axis. Pairs
/// when all boxes are in pairs and some cannot be corners; corners otherwise, which any six numbers
/// can be. `words` stands behind the first `aabb` and is left there.
BoxOrder aabb_order(Words words);

}  // namespace grelha
