#include "kernel/marks/rod.hpp"

#include <cstdint>

namespace grelha {
namespace {

/// How long an edge looks along a direction, squared; times the direction, squared.
double across(const Triple& edge, const Triple& along) {
  const Triple c = cross(edge, along);
  return dot(c, c);
}

}  // namespace

Rod rod_of(const TriangleSpans& t, std::size_t i, const Place3& from) {
  const std::uint32_t vertex[3] = {t.a[i], t.b[i], t.c[i]};
  Triple p[3], edge[3];
  for (int k = 0; k < 3; ++k)
    p[k] = vertex_of(t, vertex[k]);
  for (int k = 0; k < 3; ++k)
    edge[k] = minus(p[(k + 1) % 3], p[k]);
  const Triple sum{p[0].x + p[1].x + p[2].x, p[0].y + p[1].y + p[2].y, p[0].z + p[1].z + p[2].z};
  const Triple along{sum.x / 3 - from[0], sum.y / 3 - from[1], sum.z / 3 - from[2]};
  int longest = 0;
  for (int k = 1; k < 3; ++k)
    if (across(edge[k], along) > across(edge[longest], along))
      longest = k;
  const Triple normal = cross(edge[0], edge[1]);
  const double looks = std::sqrt(across(edge[longest], along));
  const double size = std::sqrt(dot(edge[longest], edge[longest]));
  const double width = looks > 0 ? std::abs(dot(normal, along)) / looks : 0;
  const Triple& a = p[longest];
  const Triple& b = p[(longest + 1) % 3];
  return {{{a.x, a.y, a.z}, {b.x, b.y, b.z}},
          width,
          size > 0 ? std::sqrt(dot(normal, normal)) / size : 0,
          width};
}

}  // namespace grelha
