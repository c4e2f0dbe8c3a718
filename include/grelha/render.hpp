#pragma once

#include <cstdint>

#include "grelha/camera.hpp"
#include "grelha/image.hpp"
#include "grelha/isa.hpp"
#include "grelha/render_options.hpp"
#include "grelha/stats.hpp"
#include "grelha/world.hpp"

namespace grelha {

/// At most what all threads of a render work in: a band of rows each, and the rays that wait. More
/// for a wider picture or deeper paths.
std::uint64_t thread_bytes(const Camera& camera, const RenderOptions& options);

/// Renders. The picture is the same, bit for bit, for every value of threads, packet, mailbox, isa,
/// density and grid. Throws std::invalid_argument for an instruction set that is unknown or does
/// not run here, or a bad camera or option. When `progress` stops it, what has no sample yet is
/// black. `maps` is filled when samples are spent by error.
Image render(const World& world,
             const Camera& camera,
             const RenderOptions& options,
             RenderStats& stats,
             SampleMaps* maps = nullptr);

}  // namespace grelha
