#pragma once
// Rays aimed at small objects, which the first samples of a refined picture may have missed.

#include "grelha/stats.hpp"
#include "kernel/picture/refinement.hpp"
#include "kernel/shade/strips.hpp"
#include "kernel/world/world_impl.hpp"

namespace grelha {

/// Sends rays straight from the eye to each sphere or cone that looks thinner than a pixel, one per
/// pixel of its length, and on through transparent surfaces. The pixels of a refined picture where
/// they arrive get boxes that later samples favour; until then r.missed holds the variances that
/// the objects may add to blocks.
void target_small_objects(
    const World::Impl& world, const Setup& setup, int threads, Refinement& r, TraceCounts& counts);

}  // namespace grelha
