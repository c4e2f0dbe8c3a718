#include "grelha/camera.hpp"

#include <algorithm>
#include <cmath>

#include "grelha/coordinates.hpp"
#include "kernel/base/sine.hpp"
#include "kernel/scene/shading_view.hpp"

namespace grelha {
namespace {

struct Double3 {
  double x, y, z;
};

Double3 minus(const Float3& a, const Float3& b) {
  return {
      double(a.x) - b.x,
      double(a.y) - b.y,
      double(a.z) - b.z,
  };
}
double dot(const Double3& a, const Double3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Double3 cross(const Double3& a, const Double3& b) {
  return {
      a.y * b.z - a.z * b.y,
      a.z * b.x - a.x * b.z,
      a.x * b.y - a.y * b.x,
  };
}
Double3 scaled(const Double3& a, double s) {
  return {a.x * s, a.y * s, a.z * s};
}
Double3 unit(const Double3& a) {
  return scaled(a, 1 / std::sqrt(dot(a, a)));
}

bool finite(const Float3& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

bool is_picture_side(int pixels) {
  return pixels >= 1 && pixels <= kMostSide;
}

bool lens_is_valid(const Camera& c) {
  return c.aperture >= 0 && std::isfinite(c.aperture) && c.focus > 0 && std::isfinite(c.focus);
}

bool height_is_valid(const Camera& c) {
  return c.orthographic_height > 0 && c.orthographic_height <= kLargestLength;
}

/// Squared sine of the least angle between view and up: below it rounding decides where right is.
constexpr double kLeastSineSquared = 1e-18;

/// True if the camera has a view direction, and up is not along it.
bool directions_valid(const Camera& c) {
  const Double3 view = minus(c.at, c.eye);
  const Double3 up{c.up.x, c.up.y, c.up.z};
  const double vv = dot(view, view);
  const double uu = dot(up, up);
  if (!(vv > 0) || !(uu > 0))
    return false;
  const Double3 side = cross(scaled(view, 1 / std::sqrt(vv)), scaled(up, 1 / std::sqrt(uu)));
  return dot(side, side) > kLeastSineSquared;
}

void put(float (&to)[3], const Double3& v) {
  to[0] = static_cast<float>(v.x);
  to[1] = static_cast<float>(v.y);
  to[2] = static_cast<float>(v.z);
}

}  // namespace

bool camera_is_valid(const Camera& c) {
  const bool has_angle = c.angle_deg > 0 && c.angle_deg < 180;
  const bool has_field = c.orthographic_height == 0 ? has_angle : height_is_valid(c);
  return finite(c.eye) && finite(c.at) && finite(c.up) && is_picture_side(c.width) &&
         is_picture_side(c.height) && has_field && lens_is_valid(c) && directions_valid(c);
}

double pixel_size(const Camera& c) {
  if (c.orthographic_height > 0)
    return c.orthographic_height / c.height;
  const auto [sine, cosine] = sine_cosine(c.angle_deg * 3.14159265358979323846 / 360);
  return 2 * (sine / cosine) / c.height;
}

void camera_rays(const Camera& camera, int row, std::span<Ray> rays) {
  const FrameView f = make_frame(camera);
  const float sy = .5f * static_cast<float>(f.height) - (static_cast<float>(row) + .5f);
  for (std::size_t x = 0; x < rays.size(); ++x) {
    const float sx = (static_cast<float>(x) + .5f) - .5f * static_cast<float>(f.width);
    float org[3], d[3];
    for (int k = 0; k < 3; ++k) {
      const auto moved = [&](float from) { return (from + sx * f.right[k]) + sy * f.up[k]; };
      org[k] = f.parallel ? moved(f.eye[k]) : f.eye[k];
      d[k] = f.parallel ? f.forward[k] : moved(f.forward[k]);
    }
    rays[x].org = {org[0], org[1], org[2]};
    rays[x].dir = normalized({d[0], d[1], d[2]});
  }
}

FrameView make_frame(const Camera& c) {
  const Double3 forward = unit(minus(c.at, c.eye));
  const Double3 right = unit(cross(forward, unit({c.up.x, c.up.y, c.up.z})));
  const Double3 up = cross(right, forward);
  const double pixel = pixel_size(c);
  FrameView f;
  put(f.eye, {c.eye.x, c.eye.y, c.eye.z});
  put(f.forward, forward);
  put(f.right, scaled(right, pixel));
  put(f.up, scaled(up, pixel));
  f.width = c.width;
  f.height = c.height;
  f.lens = c.aperture > 0;
  f.parallel = c.orthographic_height > 0;
  // Directions are as long as the focus is far, and rays take lengths whose squares are floats. If
  // a lens is focused that far away, rounding bends no ray against the others.
  f.focus = static_cast<float>(std::clamp(c.focus, 1e-15, 1e15));
  put(f.lens_right, scaled(right, c.aperture / 2));
  put(f.lens_up, scaled(up, c.aperture / 2));
  return f;
}

}  // namespace grelha
