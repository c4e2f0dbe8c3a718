#pragma once
// Pixels in which something thinner than two of them may show, or its shadow: where samples that
// agree may all have missed it. What is wider covers whole pixels, whose samples tell of it.

#include "grelha/stats.hpp"
#include "kernel/adaptive/pixel_marks.hpp"
#include "kernel/render/setup.hpp"
#include "kernel/world/world_impl.hpp"

namespace grelha {

/// Triangles inside of a mesh are no things of their own, see MeshRims. Shadows are those of lights'
/// centres on what lies right behind.
PixelMarks mark_small_things(const World::Impl& world,
                             const Setup& setup,
                             int threads,
                             TraceCounts& counts);

}  // namespace grelha
