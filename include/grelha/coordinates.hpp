#pragma once
// Points from arrays of any stride, of floats or doubles, as the arrays that scenes refer to.

#include <array>
#include <cstddef>
#include <vector>

namespace grelha {

/// Coordinates of points, each axis by itself: a point of the caller is (x, y, z) + offset.
struct Coordinates {
  std::vector<float> x, y, z;
  std::array<double, 3> offset{};  ///< scene units
};

/// Copies `count` points, each x y z, that lie `stride` bytes apart, at any address. The offset is
/// 0. Throws std::invalid_argument if `points` is null and `count` is not 0.
Coordinates coordinates_of(const float* points, std::ptrdiff_t stride, std::size_t count);
/// The same of doubles. The offset is subtracted in double, then the difference is rounded to
/// float. It is 0 where floats hold all coordinates as they are, else offset_of() of their box.
/// Rays and points of queries must have it subtracted too.
Coordinates coordinates_of(const double* points, std::ptrdiff_t stride, std::size_t count);

/// Returns the middle of a box, rounded to multiples of a power of two that is at least the size of
/// the box: subtracting it costs no digit.
std::array<double, 3> offset_of(const std::array<double, 3>& low,
                                const std::array<double, 3>& high);

}  // namespace grelha
