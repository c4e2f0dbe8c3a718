#pragma once
// The primitives of a scene as plain pointers.

#include <cstdint>

#include "kernel/shapes/ids.hpp"

namespace grelha {

/// The primitives themselves, by index, for what is done once a hit rather than once a test.
struct GeometryView {
  const float *tx = nullptr, *ty = nullptr, *tz = nullptr;     ///< triangle vertices
  const float *tnx = nullptr, *tny = nullptr, *tnz = nullptr;  ///< their normals, or null
  const std::uint32_t *ta = nullptr, *tb = nullptr, *tc = nullptr;
  const float *sx = nullptr, *sy = nullptr, *sz = nullptr, *sr = nullptr;
  const float* cone[10] = {};
  const float *px = nullptr, *py = nullptr, *pz = nullptr, *pnx = nullptr, *pny = nullptr,
              *pnz = nullptr;
  const std::uint32_t *plane_material = nullptr, *sphere_material = nullptr,
                      *triangle_material = nullptr, *cone_material = nullptr;
  PrimitiveIds ids;
  std::uint32_t plane_count = 0, sphere_count = 0, triangle_count = 0, cone_count = 0;
};

}  // namespace grelha
