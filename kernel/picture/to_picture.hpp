#pragma once
// Projects points of a scene into its picture.

#include "kernel/picture/rod.hpp"
#include "kernel/scene/frame.hpp"

namespace grelha {

/// A camera in double precision.
class ToPicture {
 public:
  explicit ToPicture(const FrameView& f) : f_(f) {
    for (std::size_t a = 0; a < 3; ++a) {
      eye_[a] = f.eye[a];
      ff_ += square(f.forward[a]);
      rr_ += square(f.right[a]);
      uu_ += square(f.up[a]);
    }
  }
  struct Spot {
    double x, y;   ///< pixels
    double depth;  ///< in lengths of `forward`
  };
  Spot operator()(const Point3& p) const {
    double z = 0;
    double x = 0;
    double y = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double d = p[a] - eye_[a];
      z += d * f_.forward[a];
      x += d * f_.right[a];
      y += d * f_.up[a];
    }
    z /= ff_;
    const double shrink = f_.parallel ? 1 : z;
    return {.5 * f_.width + x / (rr_ * shrink), .5 * f_.height - y / (uu_ * shrink), z};
  }
  /// Where a ray that sees a point starts.
  Point3 eye(const Point3& p) const {
    if (!f_.parallel)
      return eye_;
    const double depth = (*this)(p).depth;
    Point3 at = p;
    for (std::size_t a = 0; a < 3; ++a)
      at[a] -= depth * f_.forward[a];
    return at;
  }
  /// How wide a pixel is.
  double pixel(double depth) const { return (f_.parallel ? 1 : depth) * std::sqrt(rr_); }
  /// Pixels that a ball of a radius reaches from its middle at most, anywhere in the picture: balls
  /// look longer in its corners.
  double half_width(double radius, double depth) const {
    const double corner =
        f_.parallel ? 0 : square(.5 * f_.width) * rr_ + square(.5 * f_.height) * uu_;
    return radius / pixel(depth) * std::sqrt(1 + corner / ff_);
  }

 private:
  static double square(double x) { return x * x; }
  const FrameView& f_;
  Point3 eye_;
  double ff_ = 0;
  double rr_ = 0;
  double uu_ = 0;
};

/// Cuts off what of a rod lies behind the eye, or nearly so; false: nothing is left.
inline bool cut_behind(const ToPicture& to, Rod& rod) {
  const double z[2] = {to(rod.end[0]).depth, to(rod.end[1]).depth};
  const double least = 1e-3 * std::max(z[0], z[1]);
  if (!(least > 0))
    return false;
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t a = 0; z[k] < least && a < 3; ++a)
      rod.end[k][a] += (least - z[k]) / (z[1 - k] - z[k]) * (rod.end[1 - k][a] - rod.end[k][a]);
  return true;
}

}  // namespace grelha
