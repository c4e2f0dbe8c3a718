#pragma once
// A second opinion on a refined picture: some pixels once more, with other samples. Estimates that
// decided where to stop cannot be wrong in the same way twice.

#include <cstddef>

#include "grelha/render_options.hpp"
#include "grelha/stats.hpp"
#include "kernel/picture/block_errors.hpp"
#include "kernel/shade/setup.hpp"
#include "kernel/grid/world_impl.hpp"

namespace grelha {

/// Samples some pixels of a picture once more, by another sequence: others each time. The same for
/// any number of threads. `stats` gets the rays, r.check_samples stays as it is.
CheckSums check_error(const World::Impl& world,
                      const Setup& setup,
                      const RenderOptions& options,
                      const BlockErrors& errors,
                      const Refinement& r,
                      RenderStats& stats);

}  // namespace grelha
