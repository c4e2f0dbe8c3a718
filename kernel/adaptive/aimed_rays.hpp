#pragma once

#include "grelha/stats.hpp"
#include "kernel/adaptive/refinement.hpp"
#include "kernel/render/setup.hpp"
#include "kernel/world/world_impl.hpp"

namespace grelha {

/// Things that samples may miss: primitives that are no triangles, and triangles.
std::size_t thing_count(const World::Impl& world);

/// Sends a ray to each sphere, cone or piece of a mesh that looks thinner than a pixel, one a pixel
/// of its length, straight on through what is clear, by way of flat mirrors, and from each point
/// light on to the surface behind it. Where it arrives, the pixels of a refined picture get boxes
/// that later samples aim at; until then r.missed has what the things may add to the variances of
/// blocks.
void aim_at_small_things(
    const World::Impl& world, const Setup& setup, int threads, Refinement& r, TraceCounts& counts);

}  // namespace grelha
