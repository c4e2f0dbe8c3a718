#pragma once
// Spends samples where they help most; refinement.hpp holds the state between runs.

#include "grelha/camera.hpp"
#include "grelha/image.hpp"
#include "grelha/render_options.hpp"
#include "grelha/stats.hpp"
#include "grelha/world.hpp"
#include "kernel/shade/guarded_progress.hpp"
#include "kernel/picture/refinement.hpp"

namespace grelha {

/// Goes on until the target is met, see Picture::advance(). Returns true if it is. `stats.error`
/// and `maps`, where given, describe the picture so far; other counts are of this call. Throws like
/// render().
bool refine(const World& world,
            const Camera& camera,
            const RenderOptions& options,
            Refinement& r,
            RenderStats& stats,
            SampleMaps* maps = nullptr,
            const ShouldContinue& should_continue = {});

}  // namespace grelha
