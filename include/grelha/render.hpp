#pragma once

#include <cstdint>

#include "grelha/camera.hpp"
#include "grelha/image.hpp"
#include "grelha/isa.hpp"
#include "grelha/render_options.hpp"
#include "grelha/stats.hpp"
#include "grelha/world.hpp"

namespace grelha {

/// Returns an upper bound of the working memory of all threads of a render, in bytes: for each
/// thread a strip of rows and its queued rays. It grows with the picture's width and the depth.
std::uint64_t thread_bytes(const Camera& camera, const RenderOptions& options);

/// Renders a picture. It is the same, bit for bit, for every value of threads, packet, mailbox,
/// isa, density and grid. Throws std::invalid_argument for an instruction set that is unknown or
/// unsupported here, and for an invalid camera or option. If `progress` stops the render, pixels
/// without samples are black. `maps` is filled if RefineOptions are on.
Image render(const World& world,
             const Camera& camera,
             const RenderOptions& options,
             RenderStats& stats,
             SampleMaps* maps = nullptr);

}  // namespace grelha
