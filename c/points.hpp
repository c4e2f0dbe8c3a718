#pragma once
// Points in arrays of the caller, of any stride.

#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>

#include "c/errors.hpp"
#include "grelha/coordinates.hpp"
#include "grelha/geometry.hpp"

namespace grelha::c {

constexpr double kLargest = 1e18;  ///< what the kernel computes with

/// Coordinates x y z of points, each `stride` bytes after the one before, at any address.
template <class Number>
class Points {
 public:
  Points(const Number* data, std::ptrdiff_t stride, std::size_t count, const char* name)
      : bytes_(reinterpret_cast<const char*>(data)), stride_(stride), count_(count), name_(name) {
    if (count == 0)
      return;
    expect_there(data, name);
    if (stride == 0)
      refuse(name, "a stride of bytes from one to the next", "0");
  }

  std::size_t count() const { return count_; }
  const char* name() const { return name_; }
  Number at(std::size_t i, std::size_t axis) const {
    Number value;
    const char* const from = bytes_ + static_cast<std::ptrdiff_t>(i) * stride_;
    std::memcpy(&value, from + axis * sizeof value, sizeof value);
    return value;
  }
  Float3 point(std::size_t i) const {
    return {
        static_cast<float>(at(i, 0)), static_cast<float>(at(i, 1)), static_cast<float>(at(i, 2))};
  }
  void add_to(PointBounds& bounds, std::size_t i) const {
    for (std::size_t a = 0; a < 3; ++a)
      bounds.add(a, at(i, a));
  }
  /// Throws std::invalid_argument for a coordinate that the kernel cannot compute with.
  void expect_usable(std::size_t i) const {
    for (std::size_t a = 0; a < 3; ++a)
      if (!(std::abs(double{at(i, a)}) <= kLargest))
        refuse(name_,
               "finite numbers within 1e18",
               std::to_string(at(i, a)) + " in element " + std::to_string(i));
  }

 private:
  const char* bytes_;
  std::ptrdiff_t stride_;
  std::size_t count_;
  const char* name_;
};

}  // namespace grelha::c
