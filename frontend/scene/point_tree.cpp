#include "frontend/scene/point_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace grelha {

/// Its two longer sides come first: for a sliver they decide nearly every test of a box or point.
class PointTree::Triangle {
  /// A side of a triangle, and which corner of any box lies farthest to its left.
  struct Side {
    Side(const Point2& from, const Point2& to)
        : start(from),
          dx(to.x - from.x),
          dy(to.y - from.y),
          x(dy > 0 ? 0 : 1),
          y(dx > 0 ? 1 : 0),
          per_length(1 / std::sqrt(length())) {}
    double length() const { return dx * dx + dy * dy; }
    /// As turn() says it of the side and p, bit for bit.
    double turn(double px, double py) const { return dx * (py - start.y) - dy * (px - start.x); }

    Point2 start;
    double dx, dy;
    std::size_t x, y;  ///< 0: the box's least, 1: its largest
    double per_length;
  };

 public:
  Triangle(const Point2& a, const Point2& b, const Point2& c)
      : corner_points_{a, b, c},
        sides_{Side(a, b), Side(b, c), Side(c, a)},
        lower_{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})},
        upper_{std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})} {
    const auto shortest =
        std::min_element(sides_.begin(), sides_.end(), [](const Side& s, const Side& t) {
          return s.length() < t.length();
        });
    std::swap(*shortest, sides_.back());
  }
  /// How far the box reaches into it, by the side it crosses least: below 0 no point is in both.
  /// Rounds as has() does for every point in the box.
  double overlap(const Node& n) const {
    if (n.alive == 0 || n.x[0] > upper_.x || n.x[1] < lower_.x || n.y[0] > upper_.y ||
        n.y[1] < lower_.y)
      return -1;
    double least = std::numeric_limits<double>::infinity();
    for (const Side& s : sides_) {
      const double overlap = s.turn(n.x[s.x], n.y[s.y]);
      if (overlap < 0)
        return -1;
      least = std::min(least, overlap * s.per_length);
    }
    return least;
  }
  /// Returns true if a point lies in it, other than at a corner; false for NaN.
  bool has(const FloatPoint& at) const {
    const Point2 p{at.x, at.y};
    const auto inside = [p](const Side& s) { return s.turn(p.x, p.y) >= 0; };
    return std::ranges::all_of(sides_, inside) && std::ranges::count(corner_points_, p) == 0;
  }

 private:
  std::array<Point2, 3> corner_points_;
  std::array<Side, 3> sides_;
  Point2 lower_, upper_;
};

void PointTree::build(std::span<const Point2> points, std::span<const std::uint32_t> ids) {
  points_ = points;
  order_.assign(ids.begin(), ids.end());
  slot_.resize(points.size());
  std::size_t levels = 1;
  for (std::size_t size = order_.size(); size > kLeaf; size = (size + 1) / 2)
    ++levels;
  nodes_.assign((std::size_t(1) << levels) - 1, Node{});

  std::vector<Range> todo{{0, 0, std::uint32_t(order_.size())}};
  while (!todo.empty()) {
    const Range range = todo.back();
    todo.pop_back();
    fill_node(range);
    if (range.last - range.first <= kLeaf)
      continue;
    todo.push_back(left(range));
    todo.push_back(right(range));
  }
  positions_.resize(order_.size());
  for (std::uint32_t i = 0; i < order_.size(); ++i) {
    slot_[order_[i]] = i;
    positions_[i] = {float(points_[order_[i]].x), float(points_[order_[i]].y)};
  }
}

/// Fills one node and parts its ids in two halves along its longer side.
void PointTree::fill_node(const Range& range) {
  if (range.first == range.last)
    return;
  Node& node = nodes_[range.node];
  node.alive = range.last - range.first;
  const Point2& start = points_[order_[range.first]];
  Point2 least = start, largest = start;
  for (std::uint32_t i = range.first; i != range.last; ++i) {
    const Point2& p = points_[order_[i]];
    least = {std::min(least.x, p.x), std::min(least.y, p.y)};
    largest = {std::max(largest.x, p.x), std::max(largest.y, p.y)};
  }
  node.x[0] = float(least.x);
  node.x[1] = float(largest.x);
  node.y[0] = float(least.y);
  node.y[1] = float(largest.y);
  if (node.alive <= kLeaf)
    return;
  const bool wide = node.x[1] - node.x[0] > node.y[1] - node.y[0];
  std::nth_element(order_.begin() + range.first,
                   order_.begin() + left(range).last,
                   order_.begin() + range.last,
                   [&](std::uint32_t i, std::uint32_t j) {
                     return wide ? points_[i].x < points_[j].x : points_[i].y < points_[j].y;
                   });
}

void PointTree::remove(std::uint32_t id) {
  const std::uint32_t slot = slot_[id];
  if (positions_[slot].x != positions_[slot].x)
    return;
  positions_[slot].x = std::numeric_limits<float>::quiet_NaN();
  Range range{0, 0, std::uint32_t(order_.size())};
  for (;;) {
    --nodes_[range.node].alive;
    if (range.last - range.first <= kLeaf)
      return;
    range = slot < left(range).last ? left(range) : right(range);
  }
}

bool PointTree::any_in(const Point2& a,
                       const Point2& b,
                       const Point2& c,
                       std::uint32_t most_nodes) const {
  if (most_nodes == 0)
    return false;
  const Triangle triangle(a, b, c);
  std::array<Range, 36> todo;  // one a level waits, and 32-bit counts halve at most 32 times
  std::size_t depth = 0;
  Range range{0, 0, std::uint32_t(order_.size())};
  if (triangle.overlap(nodes_[0]) < 0)
    return false;
  for (;;) {
    if (range.last - range.first <= kLeaf) {
      for (std::uint32_t i = range.first; i != range.last; ++i)
        if (triangle.has(positions_[i]))
          return true;
      if (depth == 0)
        return false;
      range = todo[--depth];
      continue;
    }
    if (--most_nodes == 0)
      return false;
    const Range l = left(range), r = right(range);
    const double in_left = triangle.overlap(nodes_[l.node]);
    const double in_right = triangle.overlap(nodes_[r.node]);
    if (in_left >= 0 && in_right >= 0)
      todo[depth++] = in_left > in_right ? r : l;
    if (in_left >= 0 || in_right >= 0)
      range = in_left > in_right ? l : r;
    else if (depth == 0)
      return false;
    else
      range = todo[--depth];
  }
}

}  // namespace grelha
