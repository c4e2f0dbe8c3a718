#pragma once

#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// Appends a part of a file, which was read on its own, to `file`: loose primitives, materials,
/// counts and dropped primitives. Material 0 of the part stands for the last one of `file`, which
/// must have one. Throws std::bad_alloc, and then leaves no valid scene.
void append_part(SceneFile& file, const SceneFile& part);

/// Reserves memory, if available, for `times` the size of the part, so that arrays need not be
/// copied as they grow.
void reserve_for_parts(SceneFile& file, const SceneFile& part, double times) noexcept;

}  // namespace grelha
