#pragma once

#include "kernel/render.hpp"
#include "kernel/shading_view.hpp"
#include "kernel/variants.hpp"
#include "kernel/world.hpp"

namespace grelha {

/// Renders by squares that share their corners, see subdivide(): here is what tells it the colours of points.
Image render_subdivided(const World::Impl& world, const Camera& camera, const FrameView& frame, const SamplePlan& plan, const Variant& variant,
                        const RenderOptions& options, RenderStats& stats);

}  // namespace grelha
