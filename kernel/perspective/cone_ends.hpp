#pragma once
// The ends of cones, as seen from a point.

#include "kernel/perspective/viewpoint.hpp"
#include "kernel/shapes/primitives.hpp"

namespace grelha {

/// The balls at the ends of a cone; it lies in their hull.
struct Ends {
  Vector center[2];
  double radius[2];
};
inline Ends ends_of(const Cone::Fields<float>& c, const Viewpoint& from) {
  Ends e;
  e.center[0] = relative(from, c.base);
  e.radius[0] = c.radius;
  const Vector axis{
      c.axis[0],
      c.axis[1],
      c.axis[2],
  };
  const double h = c.height;
  e.center[1] = e.center[0] - scaled(-h, axis);
  e.radius[1] = c.radius + static_cast<double>(c.slope) * h;
  return e;
}

}  // namespace grelha
