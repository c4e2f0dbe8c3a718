#pragma once
// Rays in the caller's arrays, and what comes back in them.

#include <cstdint>

namespace grelha {

inline constexpr std::uint32_t kNoPrimitive = 0xFFFFFFFFu;

/// Rays in arrays of `count`. t: in, where the search ends; out, the nearest hit, or the old value
/// when there is none (closest); -infinity when something is in the way (occluded). Directions of
/// any length from 1e-18 to 1e18 (others meet nothing); t counts multiples of it. Rays with a NaN
/// or an infinity meet nothing.
struct RaySpan {
  const float *ox = nullptr, *oy = nullptr, *oz = nullptr;  ///< where rays start
  const float *dx = nullptr, *dy = nullptr, *dz = nullptr;  ///< and where to
  /// what is met at or before this t does not count
  const float* t_min = nullptr;
  float* t = nullptr;           ///< in and out, see above
  std::uint32_t* id = nullptr;  ///< out: the primitive, kNoPrimitive where nothing was met
  int count = 0;                ///< length of every array, at least 0
  /// out, or null: t of what was met as precise as it was computed; others keep theirs
  double* whole = nullptr;
};

}  // namespace grelha
