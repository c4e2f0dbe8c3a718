#pragma once
// Phases of a thread that renders, and the observer that is told of them.

#include <cstdint>

#include "grelha/rays.hpp"

namespace grelha {

/// The phases, in the order a batch goes through them.
enum class Phase : int {
  camera,    ///< making camera rays
  primary,   ///< tracing them
  bounce,    ///< tracing reflected and refracted rays
  surface,   ///< points and normals of hits, the background of misses
  light,     ///< local light and the making of shadow rays
  shadow,    ///< tracing those
  children,  ///< making reflected and refracted rays, putting them by and taking them up
  sums,      ///< sums of light to pixels
};
inline constexpr int kPhases = 8;

/// An observer is told whenever its thread goes from one phase to another, some ten times a batch.
/// It gets `rays` on the way into primary, bounce and shadow, once for each run of rays. A function
/// pointer, so the hot loops need nothing from another file.
struct Observer {
  void (*enter)(Observer&, Phase, const Rays* rays);
};

}  // namespace grelha
