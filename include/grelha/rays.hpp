#pragma once
// Rays, one or in the caller's arrays, and what they meet.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

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

/// A view of rays in arrays that the caller owns. They are read and never written.
///
/// Shapes    component a of ray i: org[a][i * org_stride], dir[a][i * dir_stride]; t_min and t_max
///           at i * t_stride. Strides count floats. 1: an array for each component; 3, with
///           org = {p, p + 1, p + 2}: points x y z x y z; 0: all rays share what stands there.
/// Units     org: scene units, within 1e18; dir: any length from 1e-18 to 1e18; t: multiples of it.
/// Requires  `count` floats of each array, and no null in org and dir unless count is 0: closest()
///           and occluded() throw std::invalid_argument.
/// Ensures   a ray meets nothing where t_max <= t_min, where its direction is longer or shorter,
///           and where a number is NaN or (of org and dir) infinite.
struct Rays {
  const float* org[3] = {};       ///< x, y and z of where rays start
  const float* dir[3] = {};       ///< x, y and z of where they go
  const float* t_min = nullptr;   ///< hits at or before it do not count; null: 0 for all
  const float* t_max = nullptr;   ///< hits at or behind it do not count; null: infinity
  std::size_t count = 0;          ///< how many rays
  std::ptrdiff_t org_stride = 1;  ///< from one ray's org to the next ray's
  std::ptrdiff_t dir_stride = 1;  ///< the same of dir
  std::ptrdiff_t t_stride = 1;    ///< the same of t_min and t_max

  /// A view of an array of rays.
  static Rays of(std::span<const Ray> rays);
  /// A view of points and directions x y z x y z, searched from t = 0 on. Throws
  /// std::invalid_argument for unequal lengths.
  static Rays of(std::span<const Float3> org, std::span<const Float3> dir);
};

/// A view of the caller's arrays for what rays meet first, as long as those of the rays. Any may be
/// null: not asked for. No other array is written, and none behind ray `count - 1`.
struct Hits {
  /// [i * stride] out: t of the nearest hit; without a hit, the ray's t_max, or infinity where that
  /// was left out. May be the array of t_max itself, if strides are equal.
  float* t = nullptr;
  /// [i * stride] out: the primitive, see primitive_of(); kNoPrimitive where nothing was met
  std::uint32_t* id = nullptr;
  /// [i] out: t in double, within 2^-45 of itself
  double* t_double = nullptr;
  std::ptrdiff_t stride = 1;  ///< of t and id, in units of four bytes

  /// A view of an array of hits.
  static Hits of(std::span<Hit> hits);
};

}  // namespace grelha
