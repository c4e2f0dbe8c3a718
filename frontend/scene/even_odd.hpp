#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "frontend/scene/sweep_line.hpp"

namespace grelha {

/// The inside of an arrangement of edges by the even-odd rule: the area above an odd number of
/// edges.
struct EvenOddFill {
  /// Triangles over the points, each turning left. They share corners and sides without gaps, and
  /// no point lies on a side.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Some point has a winding number other than 0 and 1, so other rules fill another area.
  bool is_crossed = false;
};

/// A sweep that cuts off triangles behind it (Hertel and Mehlhorn 1983). Returns nothing where
/// edges meet besides their ends, which its tests find for certain (Shamos and Hoey 1976). Points
/// come as they are swept, no two at one position; no two edges are between the same points.
std::optional<EvenOddFill> fill_even_odd(const std::vector<Point2>& points,
                                         const std::vector<OutlineEdge>& edges);

}  // namespace grelha
