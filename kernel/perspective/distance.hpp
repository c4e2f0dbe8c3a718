#pragma once
// How far primitives are from a point, and which way.

#include "kernel/perspective/viewpoint.hpp"
#include "kernel/shapes/primitives.hpp"

namespace grelha {

/// Lower bound of the distance of a primitive within `box`, as the largest of three coordinates.
double distance_of(const Primitives& primitives,
                   const Viewpoint& from,
                   std::uint32_t id,
                   const Box& box);

/// Faces that anything of a box, or within pads of it, may be seen through, a bit each.
unsigned faces_of(const Box& box, const Viewpoint& from);

}  // namespace grelha
