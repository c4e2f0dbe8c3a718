#include "kernel/shapes/triangle.hpp"

namespace grelha {

bool Triangle::is_even(const TriangleSpans& spans) {
  const std::size_t size = spans.size();
  const std::size_t vertices = spans.vertex_count();
  const std::size_t normals = spans.nx.empty() ? 0 : vertices;
  return spans.b.size() == size && spans.c.size() == size && spans.material.size() == size &&
         spans.y.size() == vertices && spans.z.size() == vertices && spans.nx.size() == normals &&
         spans.ny.size() == normals && spans.nz.size() == normals;
}

}  // namespace grelha
