#pragma once
// Points in arrays of a caller, of any stride, of floats or doubles.

#include <array>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <limits>
#include <span>

#include "grelha/geometry.hpp"

namespace grelha {

/// Largest coordinate, radius or height that scenes, rays and cameras are computed with: squares of
/// differences still fit a float.
inline constexpr double kLargestLength = 1e18;

/// Points of a caller, each x y z, at any address. They are referred to, not copied.
struct PointArray {
  const char* data = nullptr;      ///< x of the first point
  std::size_t count = 0;           ///< number of points
  std::ptrdiff_t stride = 0;       ///< bytes from one point to the next
  std::ptrdiff_t axis_stride = 0;  ///< bytes from x to y and from y to z
  bool in_double = false;          ///< the numbers are doubles, else floats
  const char* name = "points";     ///< what errors call the array

  PointArray() = default;  ///< none
  /// `n` points of floats or doubles whose x y z follow each other, `bytes` from one to the next.
  /// Throws std::invalid_argument for null and for a stride of 0, unless there are no points.
  template <std::floating_point Number>
  PointArray(const Number* points, std::ptrdiff_t bytes, std::size_t n, const char* called)
      : data(reinterpret_cast<const char*>(points)),
        count(n),
        stride(bytes),
        axis_stride(sizeof(Number)),
        in_double(sizeof(Number) == sizeof(double)),
        name(called) {
    expect_array();
  }
  /// Points that follow each other.
  explicit PointArray(std::span<const Float3> points)
      : PointArray(reinterpret_cast<const float*>(points.data()),
                   sizeof(Float3),
                   points.size(),
                   "points") {}

  /// One coordinate of point i.
  double at(std::size_t i, std::size_t axis) const {
    const char* const from = data + static_cast<std::ptrdiff_t>(i) * stride +
                             static_cast<std::ptrdiff_t>(axis) * axis_stride;
    return in_double ? number<double>(from) : number<float>(from);
  }

 private:
  void expect_array() const;
  template <class Number>
  static double number(const char* from) {
    Number value;
    std::memcpy(&value, from, sizeof value);
    return value;
  }
};

/// The bounding box of points, in scene units.
class PointBounds {
 public:
  /// Grows the box by one coordinate of a point.
  void add(std::size_t axis, double value);
  /// Returns what to subtract from the points before they are rounded to float. It is 0 if the
  /// middle of the box is at most four of its sizes from the origin: floats then resolve a
  /// millionth of the size. Else it is the middle, rounded to multiples of a power of two that is
  /// at least the size: subtracting it costs no digit. Scene files that floats cannot hold count
  /// from it as well. `before`, an offset of points that moved, stays if the middle is at most four
  /// sizes away.
  std::array<double, 3> offset(const std::array<double, 3>& before = {}) const;

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::array<double, 3> middle() const;
  double size() const;                                        ///< the longest side
  double distance(const std::array<double, 3>& point) const;  ///< from the middle
  std::array<double, 3> low_{kInfinity, kInfinity, kInfinity};
  std::array<double, 3> high_{-kInfinity, -kInfinity, -kInfinity};
};

}  // namespace grelha
