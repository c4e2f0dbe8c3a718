#pragma once
// Rays, one or in the caller's arrays, and what they meet.

#include <cstdint>
#include <limits>

#include "grelha/geometry.hpp"

namespace grelha {

inline constexpr std::uint32_t kNoPrimitive = 0xFFFFFFFFu;

/// One ray.
struct Ray {
  Float3 org;  ///< where it starts
  Float3 dir;  ///< any length from 1e-18 to 1e18; t counts multiples of it
  /// what lies strictly between these is searched
  float t_min = 0, t_max = std::numeric_limits<float>::infinity();
};

/// What a ray met first.
struct Hit {
  float t;                          ///< the point is org + t dir; without a hit, the ray's t_max
  std::uint32_t id = kNoPrimitive;  ///< see primitive_of()
  /// Whether anything was met.
  explicit operator bool() const { return id != kNoPrimitive; }
};

/// Rays in arrays of `count`. t: in, where the search ends; out, the nearest hit, or the old value
/// when there is none (closest); -infinity when something is in the way (occluded). Directions of
/// any length from 1e-18 to 1e18 (others meet nothing); t counts multiples of it. Rays with a NaN
/// or an infinity meet nothing.
struct RaySpan {
  const float *ox = nullptr, *oy = nullptr, *oz = nullptr;  ///< where rays start
  const float *dx = nullptr, *dy = nullptr, *dz = nullptr;  ///< and where to
  /// what is met at or before this t does not count; null: 0 for all
  const float* t_min = nullptr;
  float* t = nullptr;  ///< in and out, see above
  /// out, or null: the primitive, kNoPrimitive where nothing was met
  std::uint32_t* id = nullptr;
  int count = 0;  ///< length of every array, at least 0
  /// out, or null: t of what was met as precise as it was computed; others keep theirs
  double* whole = nullptr;
};

}  // namespace grelha
