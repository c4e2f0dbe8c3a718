#pragma once
// Points from arrays of any stride, of floats or doubles, as the arrays that scenes refer to.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "grelha/geometry.hpp"

namespace grelha {

/// Coordinates of points, each axis by itself: a point of the caller is (x, y, z) + offset.
struct Coordinates {
  std::vector<float> x, y, z;
  std::array<double, 3> offset{};  ///< scene units
};

/// Copies `count` points, each x y z, that lie `stride` bytes apart, at any address. The offset is
/// 0. Throws std::invalid_argument if `points` is null and `count` is not 0.
Coordinates coordinates_of(const float* points, std::ptrdiff_t stride, std::size_t count);
/// The same of doubles. The offset is that of their PointBounds. It is subtracted in double, then
/// the difference is rounded to float. Rays and points of queries must have it subtracted too.
Coordinates coordinates_of(const double* points, std::ptrdiff_t stride, std::size_t count);

/// Copies the vertices of a mesh, and the three vertices of each face, counter-clockwise from the
/// front. The triangles have no materials and no normals.
Triangles triangles_of(std::span<const Float3> vertices,
                       std::span<const std::array<std::uint32_t, 3>> faces);

/// The bounding box of points, in scene units.
class PointBounds {
 public:
  /// Grows the box by one coordinate of a point.
  void add(std::size_t axis, double value);
  /// Returns what to subtract from the points before they are rounded to float. It is 0 if the
  /// middle of the box is at most four of its sizes from the origin: floats then resolve a
  /// millionth of the size. Else it is the middle, rounded to multiples of a power of two that is
  /// at least the size: subtracting it costs no digit. Scene files that floats cannot hold count
  /// from it as well.
  std::array<double, 3> offset() const;

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::array<double, 3> low_{kInfinity, kInfinity, kInfinity};
  std::array<double, 3> high_{-kInfinity, -kInfinity, -kInfinity};
};

}  // namespace grelha
