#pragma once
// The phases of a rendering thread, and the observer that it notifies.

#include <cstdint>

#include "grelha/rays.hpp"

namespace grelha {

/// The phases, in the order in which a batch of rays passes through them.
enum class Phase : int {
  camera,    ///< making camera rays
  primary,   ///< tracing camera rays
  bounce,    ///< tracing reflected and refracted rays
  surface,   ///< points and normals of hits, the background of misses
  light,     ///< local shading, and making shadow rays
  shadow,    ///< tracing shadow rays
  children,  ///< making reflected and refracted rays, queueing and dequeueing them
  sums,      ///< converting sums of light to pixels
};
inline constexpr int kPhases = 8;

/// A callback that a thread calls whenever it changes from one phase to another, about ten times a
/// batch. On entry to primary, bounce and shadow `rays` points to the rays to trace, one call for
/// each run of rays. It is a plain function pointer, so the hot loops depend on no other file.
struct Observer {
  void (*enter)(Observer&, Phase, const Rays* rays);
};

}  // namespace grelha
