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

Triangle::Arrays Triangle::Source::arrays() const {
  Arrays out{
      .vertex = {spans.x.data(), spans.y.data(), spans.z.data()},
      .corner = {spans.a.data(), spans.b.data(), spans.c.data()},
      .material = spans.material.data(),
      .count = static_cast<std::uint32_t>(size()),
  };
  if (!spans.nx.empty()) {
    out.normal[0] = spans.nx.data();
    out.normal[1] = spans.ny.data();
    out.normal[2] = spans.nz.data();
  }
  return out;
}

namespace {

bool is_same_point(const float (&a)[3], const float (&b)[3]) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

}  // namespace

CrossingSpan triangle_span(const ExactRay& ray, const float (&corner)[3][3], double shift) {
  // no area: many triangles of a mesh whose coordinates keep few digits
  if (is_same_point(corner[0], corner[1]) || is_same_point(corner[1], corner[2]) ||
      is_same_point(corner[2], corner[0]))
    return {};
  return scalar::refine_span(
      scalar::bound_triangle(ray, corner), shift, [&] { return cross_triangle(ray, corner); });
}

}  // namespace grelha
