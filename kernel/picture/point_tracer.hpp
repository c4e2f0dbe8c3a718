#pragma once

#include "grelha/camera.hpp"
#include "grelha/render_options.hpp"
#include "grelha/stats.hpp"
#include "grelha/world.hpp"
#include "kernel/shade/guarded_progress.hpp"
#include "kernel/picture/subdivision_state.hpp"

namespace grelha {

/// Goes on with a picture by subdivision, see Picture::advance(). Returns whether it is finished.
/// Threads take tiles as they come. `stats` are of this call. Throws like render().
bool render_subdivided(const World& world,
                       const Camera& camera,
                       const RenderOptions& options,
                       SubdivisionState& picture,
                       RenderStats& stats,
                       const ShouldContinue& should_continue = {});

}  // namespace grelha
