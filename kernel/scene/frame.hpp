#pragma once

#include "grelha/camera.hpp"

namespace grelha {

/// A camera's frame: direction of a point (x, y) of the image, in pixels = forward + (x - w/2)
/// right + (h/2 - y) up. A ray through the point (a, b) of the unit disc of its lens starts at
/// eye + a lens_right + b lens_up. It goes to the point of that direction at depth `focus`. Where
/// rays are parallel, the same multiples of right and up move their origins instead.
struct FrameView {
  float eye[3] = {};
  float forward[3] = {};
  float right[3] = {};
  float up[3] = {};
  float lens_right[3] = {};
  float lens_up[3] = {};
  float focus = 1;
  int width = 0;
  int height = 0;
  bool lens = false;
  bool parallel = false;
};

/// The frame of a sound camera. Its tangent comes from a series of our own: libm's last bit depends
/// on the machine.
FrameView make_frame(const Camera& camera);

}  // namespace grelha
