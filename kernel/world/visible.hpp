#pragma once
// Which triangles queries find: those of no hidden object.

#include <cstdint>
#include <stdexcept>

#include "grelha/scene_spans.hpp"

namespace grelha {

/// Throws std::invalid_argument unless objects are disjoint ranges of triangles in ascending order.
inline void expect_objects(const GeometrySpans& g) {
  std::uint64_t next = 0;
  for (const Object& o : g.objects) {
    if (o.first_triangle < next)
      throw std::invalid_argument("objects must be disjoint and ascend");
    next = std::uint64_t{o.first_triangle} + o.triangle_count;
  }
  if (next > g.triangles.size())
    throw std::invalid_argument("an object names a triangle that is not there");
}

/// Calls visit(first, end) for runs of triangles that follow each other and are visible, in order.
template <class Visit>
void each_visible_run(const GeometrySpans& g, const Visit& visit) {
  std::uint32_t first = 0;
  const auto end_run = [&](std::uint32_t end) {
    if (first < end)
      visit(first, end);
  };
  for (const Object& o : g.objects)
    if (!o.visible) {
      end_run(o.first_triangle);
      first = o.first_triangle + o.triangle_count;
    }
  end_run(static_cast<std::uint32_t>(g.triangles.size()));
}

}  // namespace grelha
