#pragma once
// Vectors in double, and corners of triangles as such.

#include <cstdint>

#include "grelha/scene_spans.hpp"

namespace grelha {

struct Triple {
  double x, y, z;
};
inline Triple minus(const Triple& a, const Triple& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Triple cross(const Triple& a, const Triple& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double dot(const Triple& a, const Triple& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline Triple vertex_of(const TriangleSpans& t, std::uint32_t vertex) {
  return {t.x[vertex], t.y[vertex], t.z[vertex]};
}

}  // namespace grelha
