#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "frontend/scene/exact_turn.hpp"

namespace grelha {

/// Triangles without area share sides with others all the same, of which the longest then has a
/// corner between its ends: rays could slip through beside it. Such a triangle and its neighbour
/// at that side exchange it for the other diagonal of both. What is left without area can go.
void mend_flat_triangles(std::span<const Point2> points,
                         std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace grelha
