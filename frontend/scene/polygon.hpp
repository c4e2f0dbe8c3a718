#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "frontend/scene/point_tree.hpp"
#include "grelha/geometry.hpp"

namespace grelha {

/// Cuts planar polygons into triangles over their own corners by clipping ears (Meisters 1975;
/// Eberly, "Triangulation by Ear Clipping"). Concave outlines of any size: only corners that are
/// not strictly convex are tested for lying in an ear, found through a tree. Always ends; an
/// outline that crosses itself gives some triangles of its corners. Each corner is asked a few
/// times, and an ear meets about as many leaves of the tree as its length crosses, at most some
/// sqrt n. Where looking at a few of them is enough, which the triangles' signs prove afterwards,
/// no more is looked at: a million corners take .1 to 4 s. Outlines of a thousand and more are cut
/// evenly, into short triangles. One object serves many polygons and keeps its buffers.
class PolygonCutter {
 public:
  using Triangle = std::array<std::uint32_t, 3>;

  /// Appends at most corners.size() - 2 triangles, none without area, counter-clockwise where the
  /// outline is. False, and nothing appended, when the polygon has no area. Coordinates must be
  /// finite and at most 1e18.
  bool cut(std::span<const Float3> corners, std::vector<Triangle>& triangles);

  /// Twice the area long, of the last polygon cut (Newell's sum: every corner counts).
  const std::array<double, 3>& normal() const { return normal_; }

 private:
  void find_normal(std::span<const Float3> corners);
  void project(std::span<const Float3> corners);
  bool convex() const;
  void link_corners();
  void plant_tree();
  bool clip_hopefully(std::uint32_t looks, std::vector<Triangle>& triangles);
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
  std::vector<std::uint32_t> previous_, following_;  ///< ring of the corners left
  std::vector<std::uint8_t> gone_, queued_, in_tree_;
  std::vector<std::uint8_t> waits_;  ///< for the next pass: a neighbour was clipped in this one
  bool even_ = false;                ///< triangles are wanted short
  std::uint32_t looks_ = 0;          ///< at so many nodes of the tree an ear's test looks at most
  std::vector<std::uint32_t> candidates_, next_candidates_;
  std::uint32_t left_ = 0, start_ = 0;
  PointTree tree_;  ///< the corners that are flat or reflex
};

}  // namespace grelha
