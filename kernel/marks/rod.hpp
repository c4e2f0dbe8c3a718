#pragma once
// Primitives as straight rods: how thin they look from a point, and where.

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "grelha/scene_spans.hpp"
#include "kernel/marks/triple.hpp"

namespace grelha {

using Place3 = double[3];
/// A point that a scene is looked at from.
struct SeenFrom {
  Place3 at;
};

/// What holds a primitive, or what of a mesh lies beside an edge of one: all within `reach` of a
/// stretch. Seen from some point it looks no wider than `width`, and all within `aside` of the
/// stretch.
struct Rod {
  double end[2][3];
  double width, reach, aside;
  double whole = 0;  ///< length of the primitive, where the stretch is shorter

  double length() const {
    double sum = 0;
    for (int a = 0; a < 3; ++a)
      sum += (end[1][a] - end[0][a]) * (end[1][a] - end[0][a]);
    return std::sqrt(sum);
  }
};

inline Rod rod_of(const SphereSpans& s, std::size_t i) {
  const double r = std::abs(static_cast<double>(s.radius[i]));
  return {{{s.x[i], s.y[i], s.z[i]}, {s.x[i], s.y[i], s.z[i]}}, 2 * r, r, r};
}

inline Rod rod_of(const ConeSpans& c, std::size_t i) {
  const double r = std::max(std::abs(static_cast<double>(c.base_radius[i])),
                            std::abs(static_cast<double>(c.apex_radius[i])));
  Rod rod{{{c.base_x[i], c.base_y[i], c.base_z[i]}, {c.apex_x[i], c.apex_y[i], c.apex_z[i]}},
          2 * r,
          r,
          r};
  rod.width = std::min(rod.width, rod.length() + 2 * r);
  return rod;
}

/// Of a triangle: along the edge that looks longest from the point. Its width is its height over
/// it.
Rod rod_of(const TriangleSpans& t, std::size_t i, const Place3& from);

}  // namespace grelha
