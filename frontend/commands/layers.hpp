#pragma once
// What is rendered beside the colours of a picture: first hits, and alpha.

#include "frontend/commands/commands.hpp"
#include "frontend/images/image_style.hpp"
#include "frontend/scene/scene_file.hpp"
#include "grelha/render.hpp"

namespace grelha {

/// Finds the first hits of a pinhole camera's rays through the pixel centres. Depths are in the
/// file's units.
Layers first_hits(const World& world,
                  const Camera& camera,
                  const Frame& frame,
                  const LayerChoice& wanted);

/// Renders a picture without the background that the camera's rays meet, and fills in its alpha.
/// Mirrors and glass show the background. `options` have a lighting, and neither errors nor
/// subdivision. If its progress stops the render, the picture is not finished.
Image render_transparent(const World& world,
                         const Camera& camera,
                         const RenderOptions& options,
                         RenderStats& stats,
                         Alpha& alpha);

}  // namespace grelha
