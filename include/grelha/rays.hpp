#pragma once
// Rays and their hits, single or in the caller's arrays.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "grelha/geometry.hpp"

namespace grelha {

inline constexpr std::uint32_t kNoPrimitive = 0xFFFFFFFFu;

/// One ray.
struct Ray {
  Float3 org;  ///< origin
  Float3 dir;  ///< direction, of any length from 1e-18 to 1e18; t counts multiples of it
  /// hits count only strictly between these; nextafter(0, -1) as t_min includes t = 0
  float t_min = 0, t_max = std::numeric_limits<float>::infinity();
};

/// The nearest hit of a ray.
struct Hit {
  float t;                          ///< hit point: org + t dir; without a hit, the ray's t_max
  std::uint32_t id = kNoPrimitive;  ///< see primitive_of()
  /// True if the ray hit something.
  explicit operator bool() const { return id != kNoPrimitive; }
};

/// A read-only view of rays in arrays that the caller owns.
///
/// Shapes    component a of ray i: org[a][i * org_stride], dir[a][i * dir_stride]; t_min and t_max
///           at i * t_stride. Strides count floats. 1: an array for each component; 3, with
///           org = {p, p + 1, p + 2}: points x y z x y z; 0: all rays share what stands there.
/// Units     org: scene units, within 1e18; dir: any length from 1e-18 to 1e18; t: multiples of it.
/// Requires  `count` floats of each array, and no null in org and dir unless count is 0: closest()
///           and occluded() throw std::invalid_argument.
/// Ensures   a ray hits nothing where no float lies between t_min and t_max, nor where its
///           direction is longer or shorter. Neither does one with a NaN, or an infinity in org or
///           dir.
struct Rays {
  const float* org[3] = {};      ///< x, y and z of the origins
  const float* dir[3] = {};      ///< x, y and z of the directions
  const float* t_min = nullptr;  ///< hits at or before it do not count; null: 0 for all
  const float* t_max = nullptr;  ///< hits at or behind it do not count; null: infinity
  /// [i] id of a primitive that ray i does not hit, or kNoPrimitive; null: no ray has one
  const std::uint32_t* skip = nullptr;
  /// [i] ray i hits only primitives p with (QueryOptions::mask[p] & mask[i]) != 0; null: 255
  const std::uint8_t* mask = nullptr;
  std::size_t count = 0;          ///< number of rays
  std::ptrdiff_t org_stride = 1;  ///< from the org of one ray to that of the next
  std::ptrdiff_t dir_stride = 1;  ///< the same of dir
  std::ptrdiff_t t_stride = 1;    ///< the same of t_min and t_max

  /// Returns ray i.
  Ray operator[](std::size_t i) const;
  /// Returns a view of the rays [first, end).
  Rays part(std::size_t first, std::size_t end) const;
  /// Returns a view of an array of rays.
  static Rays of(std::span<const Ray> rays);
  /// Returns a view of origins and directions stored as x y z x y z; t_min is 0, t_max infinity.
  /// Throws std::invalid_argument if the lengths differ.
  static Rays of(std::span<const Float3> org, std::span<const Float3> dir);
};

/// A view of the caller's arrays for nearest hits, with one element per ray. Null pointers mark
/// outputs that are not wanted. Nothing else is written, and nothing beyond ray `count - 1`.
struct Hits {
  /// [i * stride] out: t of the nearest hit; without a hit, the ray's t_max, or infinity if
  /// Rays::t_max is null. May be the array of t_max itself if the strides are equal.
  float* t = nullptr;
  /// [i * stride] out: id of the primitive, see primitive_of(); kNoPrimitive without a hit
  std::uint32_t* id = nullptr;
  /// [i] out: t in double, with a relative error of at most 2^-45
  double* t_double = nullptr;
  /// [i] out: barycentric coordinates where the ray crosses a triangle with the vertices a, b, c:
  /// the point is (1 - u - v) a + u b + v c. Never negative, together at most 1. 0 without a hit
  /// and for other primitives. Within 2^-24, from any distance.
  float *u = nullptr, *v = nullptr;
  std::ptrdiff_t stride = 1;  ///< of t and id, in units of four bytes

  /// Returns a view of an array of hits.
  static Hits of(std::span<Hit> hits);
};

}  // namespace grelha
