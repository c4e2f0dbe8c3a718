#pragma once

#include <string>

#include "frontend/scene/scene_file.hpp"
#include "grelha/image.hpp"
#include "grelha/render_options.hpp"

namespace grelha {

/// Warns of a scene that has nothing to show: points without faces, no primitives, no light.
void warn_empty_scene(const std::string& path, const SceneFile& file, const Warn& warn);

/// Warns of a picture in which every pixel is background.
void warn_empty_image(const std::string& path,
                      const Geometry& geometry,
                      const Float3& background,
                      const Image& image,
                      const Warn& warn);

/// Warns of a scene whose light may be more than sums of light hold: a term of a sample is cut at
/// 2^20, or 2^25 over the samples a pixel. `options`: as they come to the kernel.
void warn_of_cut_light(const std::string& path,
                       const Scene& scene,
                       const RenderOptions& options,
                       const Warn& warn);

}  // namespace grelha
