#pragma once
// The point of one primitive that is nearest to a given one.

#include <cstdint>

#include "kernel/shapes/shapes.hpp"

namespace grelha {

/// As doubles, and on slivers numbers of 106 bits, tell it (nearest.hpp).
struct Foot {
  double at[3];
  double distance;
};

/// On the primitive of an id. Compiled once, for all instruction sets.
Foot foot_on(const GeometryView& geometry, std::uint32_t id, const double (&point)[3]);

}  // namespace grelha
