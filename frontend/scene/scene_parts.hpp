#pragma once

#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// Puts what a part of a file was read into, on its own, behind what `file` has: loose primitives,
/// materials, counts and what was dropped. Material 0 of the part stands for the last one of
/// `file`, which has one. Throws std::bad_alloc, and leaves no scene then.
void append_part(SceneFile& file, const SceneFile& part);

/// Takes memory, if there is, for so many times what the part has, so that arrays need not be
/// copied as they grow.
void reserve_for_parts(SceneFile& file, const SceneFile& part, double times) noexcept;

}  // namespace grelha
