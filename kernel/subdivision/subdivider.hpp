#pragma once
// Makes a picture by subdivision: interrupted, kept, gone on with, to the bits of one that was made
// in one go. Knows nothing of rays: whoever makes it says what a point sees.

#include <cstddef>
#include <functional>
#include <span>

#include "grelha/subdivision.hpp"
#include "kernel/render/guarded_progress.hpp"
#include "kernel/subdivision/subdivision_state.hpp"

namespace grelha {

/// Traces points, all different and none asked for before, and sets their colours. `from` and `to`
/// say which share of the picture is done before and after. Returns how many it traced, from the
/// first on; fewer than all to stop.
using TracePoints = std::function<std::size_t(
    std::span<const LatticePoint> points, Float3* colours, double from, double to)>;

/// Makes the picture whose pixels are their squares: the mean of four corners, or of four quarters
/// where a square is split. Returns whether it is finished: what was stopped another call goes on
/// with, unless `should_continue` says to go on all the same. Works in tiles of `tile` pixels a
/// side (0: as large as 2^24 points allow were every square split), which changes nothing but the
/// order of points.
bool subdivide(SubdivisionState& picture,
               const Subdivision& options,
               const TracePoints& trace,
               int tile = 0,
               const ShouldContinue& should_continue = {});

}  // namespace grelha
