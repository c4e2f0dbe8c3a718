#pragma once
// How far a refined picture still has to go.

#include "kernel/adaptive/pixel_errors.hpp"
#include "kernel/adaptive/refinement.hpp"

namespace grelha {

/// Samples that the pixels take until the error asked for is met, were their variances to fall on
/// as they did: those that gain most a ray are doubled, again and again, until what all of them
/// gain lies below some power of two.
double foreseen_samples(const Refinement& r, const PixelErrors& errors, double error);

}  // namespace grelha
