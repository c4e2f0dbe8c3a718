#pragma once

#include "grelha/stats.hpp"
#include "kernel/picture/refinement.hpp"
#include "kernel/shade/setup.hpp"
#include "kernel/grid/world_impl.hpp"

namespace grelha {

/// Number of objects that samples may miss: triangles and all other primitives.
std::size_t object_count(const World::Impl& world);

/// Sends a ray to each sphere, cone or piece of a mesh that looks thinner than a pixel, one per
/// pixel of its length: straight through transparent surfaces, by way of flat mirrors, and from
/// each point light on to the surface behind it. The pixels of a refined picture that a ray hits
/// get boxes that later samples favour; until then r.missed holds the variances that the objects
/// may add to blocks.
void target_small_objects(
    const World::Impl& world, const Setup& setup, int threads, Refinement& r, TraceCounts& counts);

}  // namespace grelha
