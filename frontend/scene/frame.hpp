#pragma once

#include <array>
#include <string>

#include "grelha/geometry.hpp"

namespace grelha {

/// Where a scene lies. A coordinate that a file gives is offset + coordinate in the scene / scale.
///
/// Floats have seven digits: of a survey in metres from the equator they keep decimetres. Such a
/// scene is counted from near its middle, in double until the offset is taken off. One that is so
/// small that squares of its lengths underflow is enlarged. Both are powers of two, or multiples of
/// one, so that they cost no digit.
struct Frame {
  std::array<double, 3> offset{};
  double scale = 1;

  bool operator==(const Frame&) const = default;
  /// A coordinate of the file, in the scene.
  float inside(double coordinate, std::size_t axis) const {
    return static_cast<float>((coordinate - offset[axis]) * scale);
  }
  Float3 inside(const std::array<double, 3>& p) const {
    return {inside(p[0], 0), inside(p[1], 1), inside(p[2], 2)};
  }
  /// The distance of the plane normal . p = distance from the origin, in the scene.
  double distance(const std::array<double, 3>& normal, double distance) const {
    for (std::size_t a = 0; a < 3; ++a)
      distance -= offset[a] * normal[a];
    return distance * scale;
  }
  float length(double length) const { return static_cast<float>(length * scale); }
  /// A coordinate of the scene, in the file.
  double outside(float coordinate, std::size_t axis) const {
    return offset[axis] + static_cast<double>(coordinate) / scale;
  }
  std::array<double, 3> outside(const Float3& p) const {
    return {outside(p.x, 0), outside(p.y, 1), outside(p.z, 2)};
  }
};

/// "1000 0 0", and what it is enlarged by: for messages.
std::string text_of(const Frame& frame);

}  // namespace grelha
