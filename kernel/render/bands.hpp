#pragma once

#include <functional>

#include "grelha/part.hpp"
#include "kernel/render/setup.hpp"
#include "kernel/world/world_impl.hpp"

namespace grelha {

/// A part of a picture, at most kBandRows rows, and the number its renderer knows it by.
struct Band {
  std::size_t number;
  Part part;
};

/// Sets `band` to number `turn` of the bands to render; returns false when none is left. Called by
/// all threads, possibly at the same time.
using NextBand = std::function<bool(std::size_t turn, Band&)>;

/// Handed the sums of a band, [rows][width][3] in units of 1 / kLightUnit, by the thread that
/// rendered it, while others do the same; returns false to stop.
using TakeBand = std::function<bool(const Band&, const std::int64_t* sums)>;

/// Renders at most `most` bands in parallel, each by the thread that is free next (OpenMP, dynamic
/// schedule over bands of rows). An exception from one of the functions ends the program.
void render_bands(const World::Impl& world,
                  const Setup& setup,
                  const RenderOptions& options,
                  std::size_t most,
                  const NextBand& next,
                  const TakeBand& take,
                  RenderStats& stats);

}  // namespace grelha
