#include "kernel/adaptive/rod.hpp"

#include <cstdint>

namespace grelha {
namespace {

struct Triple {
  double x, y, z;
};
Triple minus(const Triple& a, const Triple& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Triple cross(const Triple& a, const Triple& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(const Triple& a, const Triple& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Twice the area of what a triangle covers across a direction, over its longest edge there.
double height_across(const Triple (&edge)[3], const Triple& along) {
  const double dd = dot(along, along);
  if (!(dd > 0))
    return 0;
  const double area = std::abs(dot(cross(edge[0], edge[1]), along)) / std::sqrt(dd);
  double longest = 0;
  for (const Triple& e : edge) {
    const double d = dot(e, along);
    longest = std::max(longest, dot(e, e) - d * d / dd);
  }
  return longest > 0 ? area / std::sqrt(longest) : 0;
}

}  // namespace

Rod rod_of(const TriangleSpans& t, std::size_t i, const Place3& from) {
  const std::uint32_t vertex[3] = {t.a[i], t.b[i], t.c[i]};
  Triple p[3], edge[3];
  for (int k = 0; k < 3; ++k)
    p[k] = {t.x[vertex[k]], t.y[vertex[k]], t.z[vertex[k]]};
  int longest = 0;
  for (int k = 0; k < 3; ++k) {
    edge[k] = minus(p[(k + 1) % 3], p[k]);
    if (dot(edge[k], edge[k]) > dot(edge[longest], edge[longest]))
      longest = k;
  }
  const Triple sum{p[0].x + p[1].x + p[2].x, p[0].y + p[1].y + p[2].y, p[0].z + p[1].z + p[2].z};
  const Triple along{sum.x / 3 - from[0], sum.y / 3 - from[1], sum.z / 3 - from[2]};
  const Triple normal = cross(edge[0], edge[1]);
  const double size = std::sqrt(dot(edge[longest], edge[longest]));
  const Triple& a = p[longest];
  const Triple& b = p[(longest + 1) % 3];
  return {{{a.x, a.y, a.z}, {b.x, b.y, b.z}},
          height_across(edge, along),
          size > 0 ? std::sqrt(dot(normal, normal)) / size : 0};
}

}  // namespace grelha
