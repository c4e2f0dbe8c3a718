#pragma once
// The points that shapes use. Other vertices may be anything.

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "grelha/coordinates.hpp"
#include "grelha/geometry.hpp"

namespace grelha {

/// Calls visit(i) for each point that spheres or triangles use.
template <class Visit>
void each_used(const Geometry& shapes, std::size_t points, const Visit& visit) {
  for (std::size_t i = 0; i < shapes.spheres.size(); ++i)
    visit(i);
  const Triangles& t = shapes.triangles;
  std::vector<char> seen(t.a.empty() ? 0 : points);
  for (const std::vector<std::uint32_t>* const corner : {&t.a, &t.b, &t.c})
    for (const std::uint32_t vertex : *corner) {
      if (vertex >= points)
        throw std::invalid_argument("a triangle names a vertex that is not there");
      if (!std::exchange(seen[vertex], 1))
        visit(vertex);
    }
}

/// Their box.
inline PointBounds used_bounds(const PointArray& points, const Geometry& shapes) {
  PointBounds bounds;
  each_used(shapes, points.count, [&](std::size_t i) {
    for (std::size_t a = 0; a < 3; ++a)
      bounds.add(a, points.at(i, a));
  });
  return bounds;
}

}  // namespace grelha
