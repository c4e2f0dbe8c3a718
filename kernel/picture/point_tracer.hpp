#pragma once

#include "grelha/camera.hpp"
#include "grelha/render_options.hpp"
#include "grelha/stats.hpp"
#include "grelha/world.hpp"
#include "kernel/picture/subdivided.hpp"

namespace grelha {

/// Goes on with a picture by subdivision, see subdivide(): here is what tells it the colours of
/// points. Whether it is finished. options.progress stops it, soon. It must not look at the
/// picture, which threads are at work on; `rest` may, which is asked then, while none is, whether
/// to go on all the same. From the picture, or from a copy, another call goes on, here or on
/// another machine. `stats` are of this call. Throws like render().
bool render_subdivided(const World& world,
                       const Camera& camera,
                       const RenderOptions& options,
                       Subdivided& picture,
                       RenderStats& stats,
                       const std::function<bool()>& rest = {});

}  // namespace grelha
