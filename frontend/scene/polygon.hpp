#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "frontend/scene/double3.hpp"
#include "frontend/scene/outline.hpp"
#include "grelha/geometry.hpp"

namespace grelha {

/// Newell's sum over the corners: twice the area of each part of any surface that the outline
/// bounds, along its normal. Corners on one line give zero.
Double3 newell_sum(std::span<const Float3> corner_points);

/// The normal of a polygon of three corners or more, with twice the area as its length (Newell's
/// sum over all corners). If parts with opposite turns cancel in the sum, the normal of a triangle
/// over the corners.
Double3 polygon_normal(std::span<const Float3> corner_points);

/// `sum` or, where it is larger, the normal of a large triangle over the corners, turned as the sum
/// is, or as the first corners are.
Double3 larger_normal(std::span<const Float3> corner_points, const Double3& sum);

/// A position on a side of a polygon: the share of the way from a corner to the next one.
struct PositionOnSide {
  std::uint32_t corner;
  double share;
};
/// A crossing of two sides.
using SideCrossing = std::array<PositionOnSide, 2>;

/// Interpolates values of a polygon's corners at a crossing: the mean of both sides.
Float3 at_crossing(std::span<const Float3> of_corners, const SideCrossing& crossing);

/// Cuts planar polygons into triangles over their own corners. A convex one becomes a fan. For any
/// other a sweep (Outline) fills the inside by the even-odd rule. If the outline crosses itself,
/// the triangles are over corners and crossings. A million corners take seconds. One object serves
/// many polygons and keeps its buffers.
class PolygonSplitter {
 public:
  using Triangle = std::array<std::uint32_t, 3>;
  enum class Result {
    kCut,       ///< at most corners - 2 triangles, none without area
    kFilled,    ///< it crosses itself: its inside by the even-odd rule
    kFolded,    ///< bent so far that it hides parts of itself: what is seen along its normal
    kNoArea,    ///< no triangle
    kCutLimit,  ///< it crosses itself too often (Outline::kMostCuts): no triangle
  };

  /// Appends triangles, counter-clockwise where the outline is. Coordinates must be finite and at
  /// most 1e18. Numbers from corner_points.size() on are of intersections().
  Result cut(std::span<const Float3> corner_points, std::vector<Triangle>& triangles);

  /// The intersections of sides of the last polygon cut, if it was filled.
  std::span<const SideCrossing> intersections() const { return intersections_; }

  /// The normal of the last polygon cut: polygon_normal(), or larger_normal() if it was filled.
  const std::array<double, 3>& normal() const { return normal_; }

 private:
  bool project(std::span<const Float3> corner_points);
  Point2 projected(const Float3& p) const;
  bool is_convex() const;
  Result fill(std::span<const Float3> corner_points, std::vector<Triangle>& triangles);
  bool is_whole(std::span<const Float3> corner_points, std::span<const Triangle> triangles) const;
  void record_intersections(std::span<const Float3> corner_points, const Outline& outline);

  std::array<double, 3> normal_{};
  /// [corners] seen along the normal's largest axis; front side up
  std::vector<Point2> points_;
  std::array<int, 2> axes_{};  ///< those that are seen
  std::vector<SideCrossing> intersections_;
};

}  // namespace grelha
