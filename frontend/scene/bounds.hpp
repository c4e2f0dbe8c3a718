#pragma once

#include "grelha/geometry.hpp"

namespace grelha {

/// The bounding box of all finite primitives. Vertices count if a triangle uses them.
struct SceneBounds {
  bool empty = true;
  Float3 low, high;
};

SceneBounds bounds_of(const Geometry& geometry);

}  // namespace grelha
