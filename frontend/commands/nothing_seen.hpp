#pragma once

#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// Warns of a picture that would show nothing, and says what to do: points without faces, no
/// primitives, no light, everything behind the eye or outside the view. Each is said only when it
/// is sure: a primitive is outside the view when all of it lies beyond one of the view's sides.
void warn_empty_image(const std::string& path,
                      const SceneFile& file,
                      const Camera& camera,
                      const Warn& warn);

}  // namespace grelha
