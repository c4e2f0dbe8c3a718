#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "frontend/scene/exact_turn.hpp"

namespace grelha {

/// A balanced k-d tree over points, which are only removed. Tests if a triangle holds a remaining
/// point. Visits only boxes that the triangle crosses, the deepest inside it first.
class PointTree {
 public:
  static constexpr std::uint32_t kAllNodes = 0xffffffff;

  /// `points[i]` for i in `ids`; `points` must stay in place. Their coordinates must be floats'.
  void build(std::span<const Point2> points, std::span<const std::uint32_t> ids);
  void remove(std::uint32_t id);
  /// Returns true if most points are removed: a new tree would answer faster.
  bool is_thin() const { return 2 * std::size_t(nodes_[0].alive) < order_.size(); }
  /// Returns whether a point left lies in the closed triangle (which turns left), other than at one
  /// of its corners. Gives up, and says no, when it has looked below so many nodes.
  bool any_in(const Point2& a,
              const Point2& b,
              const Point2& c,
              std::uint32_t most_nodes = kAllNodes) const;

 private:
  static constexpr std::uint32_t kLeaf = 8;
  struct Node {
    float x[2] = {}, y[2] = {};  ///< least and largest of the points it was built with
    std::uint32_t alive = 0;
  };
  struct FloatPoint {
    float x, y;
  };
  class Triangle;
  struct Range {
    std::uint32_t node, first, last;
  };
  Range left(const Range& r) const {
    return {2 * r.node + 1, r.first, r.first + (r.last - r.first) / 2};
  }
  Range right(const Range& r) const {
    return {2 * r.node + 2, r.first + (r.last - r.first) / 2, r.last};
  }
  void fill_node(const Range& range);

  std::span<const Point2> points_;
  std::vector<std::uint32_t> order_;   ///< ids, each node's in a run
  std::vector<std::uint32_t> slot_;    ///< [points] where an id stands in order_
  std::vector<FloatPoint> positions_;  ///< [order_] where they are; no number once removed
  std::vector<Node> nodes_;            ///< root 0, children 2k+1 and 2k+2
};

}  // namespace grelha
