#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "frontend/scene/exact_turn.hpp"

namespace grelha {

/// Replaces triangles without area. The longest side of such a triangle has a corner between its
/// ends, and rays could slip through there. The triangle and its neighbour at that side exchange it
/// for the other diagonal of both. Triangles that still have no area can then be dropped.
void fix_flat_triangles(std::span<const Point2> points,
                        std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace grelha
