#pragma once
// Where places of a scene show in its picture.

#include "kernel/marks/pixel_marks.hpp"
#include "kernel/marks/rod.hpp"
#include "kernel/scene/frame.hpp"

namespace grelha {

/// A camera in double.
class ToPicture {
 public:
  explicit ToPicture(const FrameView& f) : f_(f) {
    for (int a = 0; a < 3; ++a) {
      eye[a] = f.eye[a];
      ff_ += square(f.forward[a]);
      rr_ += square(f.right[a]);
      uu_ += square(f.up[a]);
    }
  }
  struct Spot {
    double x, y;   ///< pixels
    double depth;  ///< in lengths of `forward`
  };
  Spot operator()(const Place3& p) const {
    double z = 0;
    double x = 0;
    double y = 0;
    for (int a = 0; a < 3; ++a) {
      const double d = p[a] - eye[a];
      z += d * f_.forward[a];
      x += d * f_.right[a];
      y += d * f_.up[a];
    }
    z /= ff_;
    return {.5 * f_.width + x / (rr_ * z), .5 * f_.height - y / (uu_ * z), z};
  }
  /// The depth of what lies so far away straight on.
  double depth_of(double distance) const { return distance / std::sqrt(ff_); }
  /// How wide a pixel is.
  double pixel(double depth) const { return depth * std::sqrt(rr_); }
  /// Pixels that a ball of a radius reaches from its middle at most, anywhere in the picture: balls
  /// look longer in its corners.
  double reach(double radius, double depth) const {
    const double corner = square(.5 * f_.width) * rr_ + square(.5 * f_.height) * uu_;
    return radius / pixel(depth) * std::sqrt(1 + corner / ff_);
  }

  Place3 eye;

 private:
  static double square(double x) { return x * x; }
  const FrameView& f_;
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
  for (int k = 0; k < 2; ++k)
    for (int a = 0; z[k] < least && a < 3; ++a)
      rod.end[k][a] += (least - z[k]) / (z[1 - k] - z[k]) * (rod.end[1 - k][a] - rod.end[k][a]);
  return true;
}

/// Calls go_on(x0, y0, x1, y1) for boxes around the way from one spot to another, as long as it
/// says so; returns whether it always did.
template <class GoOn>
bool each_box_on_way(const ToPicture::Spot& a,
                     const ToPicture::Spot& b,
                     double reach,
                     double most,
                     const GoOn& go_on) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double steps = std::clamp(std::ceil(std::max(std::abs(dx), std::abs(dy))), 1., most);
  for (int i = 0; i < steps; ++i) {
    const double x0 = a.x + i / steps * dx;
    const double y0 = a.y + i / steps * dy;
    const double x1 = a.x + (i + 1) / steps * dx;
    const double y1 = a.y + (i + 1) / steps * dy;
    if (!go_on(std::min(x0, x1) - reach,
               std::min(y0, y1) - reach,
               std::max(x0, x1) + reach,
               std::max(y0, y1) + reach))
      return false;
  }
  return true;
}

/// Marks the way from one spot to another.
inline void mark_way(const ToPicture::Spot& a,
                     const ToPicture::Spot& b,
                     double reach,
                     PixelMarks& marks) {
  each_box_on_way(a, b, reach, marks.most_steps(), [&](double x0, double y0, double x1, double y1) {
    marks.mark(x0, y0, x1, y1);
    return true;
  });
}

/// Whether that would mark no pixel more.
inline bool is_way_marked(const ToPicture::Spot& a,
                          const ToPicture::Spot& b,
                          double reach,
                          const PixelMarks& marks) {
  return each_box_on_way(
      a, b, reach, marks.most_steps(), [&](double x0, double y0, double x1, double y1) {
        return marks.has_all(x0, y0, x1, y1);
      });
}

}  // namespace grelha
