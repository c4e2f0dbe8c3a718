#pragma once
// Looks for what the samples of a refined picture may have missed.

#include "grelha/stats.hpp"
#include "kernel/world/world_impl.hpp"
#include "kernel/adaptive/pixel_errors.hpp"
#include "kernel/adaptive/refinement.hpp"
#include "kernel/render/setup.hpp"

namespace grelha {

/// Asks of every pixel whose samples agree whether anything can hide there; sets `inside` and
/// `around` of the picture. `error`: what is asked for, or 0.
void find_hidden_features(const World::Impl& world,
                          const Setup& setup,
                          const PixelErrors& errors,
                          double error,
                          int threads,
                          Refinement& r,
                          TraceCounts& counts);

}  // namespace grelha
