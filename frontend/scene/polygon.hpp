#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "frontend/scene/outline.hpp"
#include "frontend/scene/point_tree.hpp"
#include "grelha/geometry.hpp"

namespace grelha {

/// A position on a side of a polygon: the share of the way from a corner to the next one.
struct PositionOnSide {
  std::uint32_t corner;
  double share;
};
/// A crossing of two sides.
using SideCrossing = std::array<PositionOnSide, 2>;

/// Interpolates values of a polygon's corners at a crossing: the mean of both sides.
Float3 at_crossing(std::span<const Float3> of_corners, const SideCrossing& crossing);

/// Cuts planar polygons into triangles over their own corners by clipping ears (Meisters 1975;
/// Eberly, "Triangulation by Ear Clipping"). Outlines may be concave and of any size: only corners
/// that are not strictly convex can lie in an ear, and a tree finds them. If an outline crosses
/// itself, a sweep (Outline) triangulates its inside by the even-odd rule, over corners and
/// crossings. Each corner is tested a few times, and an ear visits about as many leaves of the tree
/// as its length crosses, at most some sqrt n. A first pass looks at only a few leaves, and the
/// triangles' signs prove afterwards that this was enough: a million corners take .1 to 4 s.
/// Outlines of a thousand and more are cut evenly, into short triangles. One object serves many
/// polygons and keeps its buffers.
class PolygonSplitter {
 public:
  using Triangle = std::array<std::uint32_t, 3>;
  enum class Result {
    kCut,       ///< at most corners - 2 triangles, none without area
    kFilled,    ///< it crosses itself: its inside by the even-odd rule
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
  bool convex() const;
  bool is_simple() const;
  Result cut_up(std::span<const Float3> corner_points, std::vector<Triangle>& triangles);
  Result fill(std::span<const Float3> corner_points,
              const Outline& outline,
              Outline::State state,
              std::vector<Triangle>& triangles);
  void record_intersections(std::span<const Float3> corner_points, const Outline& outline);
  void clip(std::vector<Triangle>& triangles);
  void link_vertices();
  void build_tree();
  bool clip_fast(std::uint32_t looks, std::vector<Triangle>& triangles);
  void clip_ears(std::vector<Triangle>& triangles);
  bool clip_candidates(std::vector<Triangle>& triangles);
  bool try_clip(std::uint32_t corner, std::vector<Triangle>& triangles);
  void force_clip(std::vector<Triangle>& triangles);
  void remove(std::uint32_t corner);
  void queue(std::uint32_t corner);
  void take_queue();
  double turn(std::uint32_t corner) const;
  bool blocked(std::uint32_t corner) const;

  std::array<double, 3> normal_{};
  /// [corners] seen along the normal's largest axis; front side up
  std::vector<Point2> points_;
  std::array<int, 2> axes_{};                        ///< those that are seen
  std::vector<std::uint32_t> previous_, following_;  ///< ring of the corners left
  std::vector<std::uint8_t> gone_, queued_, in_tree_;
  std::vector<std::uint8_t> waits_;  ///< for the next pass: a neighbour was clipped in this one
  bool even_ = false;                ///< triangles are wanted short
  bool forced_ = false;              ///< a corner was clipped that is no ear
  std::uint32_t looks_ = 0;          ///< most nodes of the tree that an ear's test looks at
  std::vector<std::uint32_t> candidates_, next_candidates_;
  std::uint32_t left_ = 0, start_ = 0;
  PointTree tree_;  ///< the corners that are flat or reflex
  std::vector<SideCrossing> intersections_;
};

}  // namespace grelha
