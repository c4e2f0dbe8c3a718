#pragma once

#include "frontend/scene/scene_file.hpp"
#include "grelha/image.hpp"

namespace grelha {

/// Warns of a scene that has nothing to show: points without faces, no primitives, no light.
void warn_empty_scene(const std::string& path, const SceneFile& file, const Warn& warn);

/// Warns of a picture in which every pixel is background.
void warn_empty_image(const std::string& path,
                      const Geometry& geometry,
                      const Float3& background,
                      const Image& image,
                      const Warn& warn);

}  // namespace grelha
