#pragma once

#include <functional>

#include "grelha/part.hpp"
#include "kernel/shade/setup.hpp"
#include "kernel/grid/world_impl.hpp"

namespace grelha {

/// A part of a picture, at most kStripRows rows, and the number its renderer knows it by.
struct Strip {
  std::size_t number;
  Part part;
};

/// Sets `strip` to number `turn` of the strips to render; returns false when none is left. Called
/// by all threads, possibly at the same time.
using NextStrip = std::function<bool(std::size_t turn, Strip&)>;

/// Handed the sums of a strip, [rows][width][3] in units of 1 / kLightUnit, by the thread that
/// rendered it, while others do the same; returns false to stop.
using TakeStrip = std::function<bool(const Strip&, const std::int64_t* sums)>;

/// Renders at most `most` strips in parallel, each by the thread that is free next (OpenMP, dynamic
/// schedule over strips of rows). An exception from one of the functions ends the program.
void render_strips(const World::Impl& world,
                   const Setup& setup,
                   const RenderOptions& options,
                   std::size_t most,
                   const NextStrip& next,
                   const TakeStrip& take,
                   RenderStats& stats);

}  // namespace grelha
