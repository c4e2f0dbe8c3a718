#pragma once

#include "grelha/geometry.hpp"

namespace grelha {

/// The box of all that has an end; vertices count where a triangle names them.
struct SceneBounds {
  bool empty = true;
  Float3 low, high;
};

SceneBounds bounds_of(const Geometry& geometry);

}  // namespace grelha
