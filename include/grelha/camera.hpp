#pragma once

#include <span>

#include "grelha/geometry.hpp"
#include "grelha/rays.hpp"

namespace grelha {

inline constexpr int kMostSide = 65536;  ///< of a picture, in pixels

/// A camera looking from `eye` to `at`. Pixel (0,0) is the upper left one; with one sample a pixel
/// rays go through centres.
struct Camera {
  /// up: neither zero nor parallel to the view (see camera_is_valid)
  Float3 eye{0, 0, 1}, at, up{0, 1, 0};
  /// full vertical field of view, between the outer edges of the outermost rows
  double angle_deg = 45;
  int width = 512, height = 512;  ///< pixels, each from 1 to kMostSide; pixels are square
  double aperture = 0;            ///< diameter of a thin lens, scene units; 0: pinhole
  /// distance, along the view, of the plane that is sharp; scene units, > 0
  double focus = 1;
  /// > 0: orthographic. Rays are parallel and start on the plane across the view at the eye, of
  /// which the picture shows this height; scene units. The angle is then not read.
  double orthographic_height = 0;
};

/// Returns true if rays can be made for this camera: finite numbers, eye != at, up not along the
/// view, 0 < angle < 180 unless it is orthographic.
bool camera_is_valid(const Camera& camera);

/// Width and height of a pixel at a distance of 1 from the eye, or at any distance from an
/// orthographic camera; scene units. They are the same bits on every machine.
double pixel_size(const Camera& camera);

/// Writes the rays [camera.width] through the centres of a row's pixels, row 0 on top, without a
/// lens. Directions have length 1. A picture of one sample a pixel is made of these, to the bit.
void camera_rays(const Camera& camera, int row, std::span<Ray> rays);

}  // namespace grelha
