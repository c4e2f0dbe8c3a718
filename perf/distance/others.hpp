#pragma once
// Other trees that find closest points of triangles, each null where CMake did not find it.

#include <memory>
#include <span>
#include <string>

#include "grelha/distance.hpp"
#include "grelha/geometry.hpp"

namespace grelha::perf {

/// Closest points of the triangles of a scene, by another program.
class OtherTree {
 public:
  virtual ~OtherTree() = default;
  /// Finds the closest point, its distance and its triangle for each point.
  virtual void closest(std::span<const Float3> points, std::span<ClosestPoint> found) const = 0;
};

/// Embree's rtcPointQuery, whose callback computes in float; a scene of quality MEDIUM.
std::unique_ptr<OtherTree> make_embree_tree(const Triangles& triangles);
/// CGAL's AABB tree over Simple_cartesian<double>, with its own hints (a k-d tree of vertices).
std::unique_ptr<OtherTree> make_cgal_tree(const Triangles& triangles);

}  // namespace grelha::perf
