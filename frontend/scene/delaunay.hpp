#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "frontend/scene/exact_turn.hpp"

namespace grelha {

/// Flips sides that two triangles share until the triangulation is Delaunay within its outline
/// (Lawson 1977): its least angles are as large as they can be, and few triangles are slivers. The
/// number of flips is bounded by a multiple of the number of triangles.
///
/// Triangles without area go first. The longest side of such a triangle has a corner between its
/// ends, and rays could slip through there. Those that still have no area can then be dropped.
void make_delaunay(std::span<const Point2> points,
                   std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace grelha
