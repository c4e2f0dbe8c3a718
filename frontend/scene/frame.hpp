#pragma once

#include <array>
#include <string>

#include "grelha/geometry.hpp"

namespace grelha {

/// The coordinate frame of a scene. A coordinate in the file is offset + coordinate in the scene /
/// scale.
///
/// Floats have seven digits: for a survey in metres from the equator they resolve decimetres. The
/// coordinates of such a scene count from near its middle, and are doubles until the offset is
/// subtracted. A scene so small that squares of its lengths underflow is enlarged. The scale is a
/// power of two and the offset a multiple of one, so they cost no digit.
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

/// "1000 0 0", and the scale: for messages.
std::string text_of(const Frame& frame);

}  // namespace grelha
