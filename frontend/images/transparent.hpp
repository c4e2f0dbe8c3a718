#pragma once

#include "frontend/images/image_style.hpp"
#include "grelha/render.hpp"

namespace grelha {

/// Renders a picture without the background that the camera's rays meet, and fills in its alpha.
/// Mirrors and glass show the background. `options` have a lighting, and neither errors nor
/// subdivision. If its progress stops the render, the picture is not finished.
Image render_transparent(const World& world,
                         const Camera& camera,
                         const RenderOptions& options,
                         RenderStats& stats,
                         Alpha& alpha);

}  // namespace grelha
