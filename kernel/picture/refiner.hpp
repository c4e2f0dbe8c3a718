#pragma once
// Spends samples where they help most; refinement.hpp has what is kept in between.

#include <functional>

#include "grelha/camera.hpp"
#include "grelha/image.hpp"
#include "kernel/picture/refinement.hpp"
#include "grelha/render_options.hpp"
#include "grelha/stats.hpp"
#include "grelha/world.hpp"

namespace grelha {

/// Goes on until what is asked for is met; whether it is. options.progress stops it, soon: after
/// the pixels in work. It must not look at the picture, which threads are at work on; `rest` may,
/// which is asked then, while none is, whether to go on all the same. From the picture, or from a
/// copy, another call goes on, here or on another machine. `stats.error` and `maps`, where wanted,
/// are of the picture so far; other counts are of this call. Throws like render().
bool refine(const World& world,
            const Camera& camera,
            const RenderOptions& options,
            Refinement& r,
            RenderStats& stats,
            SampleMaps* maps = nullptr,
            const std::function<bool()>& rest = {});

}  // namespace grelha
