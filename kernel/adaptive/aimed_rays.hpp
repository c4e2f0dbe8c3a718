#pragma once

#include "grelha/stats.hpp"
#include "kernel/adaptive/refinement.hpp"
#include "kernel/render/setup.hpp"
#include "kernel/world/world_impl.hpp"

namespace grelha {

/// Number of things that samples may miss: triangles and all other primitives.
std::size_t thing_count(const World::Impl& world);

/// Sends a ray to each sphere, cone or piece of a mesh that looks thinner than a pixel, one per
/// pixel of its length: straight through transparent surfaces, by way of flat mirrors, and from
/// each point light on to the surface behind it. The pixels of a refined picture that a ray arrives
/// at get boxes that later samples aim at; until then r.missed holds the variances that the things
/// may add to blocks.
void aim_at_small_things(
    const World::Impl& world, const Setup& setup, int threads, Refinement& r, TraceCounts& counts);

}  // namespace grelha
