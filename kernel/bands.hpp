#pragma once

#include <functional>
#include <span>

#include "kernel/part.hpp"
#include "kernel/setup.hpp"
#include "kernel/world.hpp"

namespace grelha {

/// Parts of a picture, at most kBandRows rows each.
using Bands = std::span<const Part>;

/// Handed the sums of band `i`, [rows][width][3] in units of 1 / kLightUnit, by the thread that rendered it, while others do the
/// same; returns false to stop. What it throws ends the program.
using TakeBand = std::function<bool(std::size_t i, const std::int64_t* sums)>;

/// Renders the bands in parallel, in about their order. Whether all were rendered.
bool render_bands(const World::Impl& world, const Setup& setup, const RenderOptions& options, Bands bands, const TakeBand& take, RenderStats& stats);

}  // namespace grelha
