#include "frontend/point_tree.hpp"

#include <algorithm>
#include <array>

namespace grelha {
namespace {

/// Whether the box lies wholly to the right of the line a to b. Rounds as turn() does for every point in the box, so
/// that no point turn() accepts is missed.
bool beyond(const Point2& a, const Point2& b, const Point2& lower, const Point2& upper) {
  const Point2 nearest{b.y - a.y > 0 ? lower.x : upper.x, b.x - a.x > 0 ? upper.y : lower.y};
  return turn(a, b, nearest) < 0;
}

}  // namespace

void PointTree::build(std::span<const Point2> points, std::span<const std::uint32_t> ids) {
  points_ = points;
  order_.assign(ids.begin(), ids.end());
  present_.assign(order_.size(), 1);
  slot_.resize(points.size());
  std::size_t levels = 1;
  for (std::size_t size = order_.size(); size > kLeaf; size = (size + 1) / 2) ++levels;
  nodes_.assign((std::size_t(1) << levels) - 1, Node{});

  std::vector<Range> todo{{0, 0, std::uint32_t(order_.size())}};
  while (!todo.empty()) {
    const Range range = todo.back();
    todo.pop_back();
    settle(range);
    if (range.last - range.first <= kLeaf) continue;
    todo.push_back(left(range));
    todo.push_back(right(range));
  }
  for (std::uint32_t i = 0; i < order_.size(); ++i) slot_[order_[i]] = i;
}

/// Fills one node and parts its ids in two halves along its longer side.
void PointTree::settle(const Range& range) {
  if (range.first == range.last) return;
  Node& node = nodes_[range.node];
  node.alive = range.last - range.first;
  node.lower = node.upper = points_[order_[range.first]];
  for (std::uint32_t i = range.first; i != range.last; ++i) {
    const Point2& p = points_[order_[i]];
    node.lower = {std::min(node.lower.x, p.x), std::min(node.lower.y, p.y)};
    node.upper = {std::max(node.upper.x, p.x), std::max(node.upper.y, p.y)};
  }
  if (node.alive <= kLeaf) return;
  const bool wide = node.upper.x - node.lower.x > node.upper.y - node.lower.y;
  std::nth_element(order_.begin() + range.first, order_.begin() + left(range).last, order_.begin() + range.last,
                   [&](std::uint32_t i, std::uint32_t j) {
                     return wide ? points_[i].x < points_[j].x : points_[i].y < points_[j].y;
                   });
}

void PointTree::remove(std::uint32_t id) {
  const std::uint32_t slot = slot_[id];
  if (!present_[slot]) return;
  present_[slot] = 0;
  Range range{0, 0, std::uint32_t(order_.size())};
  for (;;) {
    --nodes_[range.node].alive;
    if (range.last - range.first <= kLeaf) return;
    range = slot < left(range).last ? left(range) : right(range);
  }
}

bool PointTree::any_in(const Point2& a, const Point2& b, const Point2& c) const {
  const Point2 lower{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})};
  const Point2 upper{std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})};
  std::array<Range, 72> todo;  // two per level, and 32-bit counts halve at most 32 times
  std::size_t depth = 0;
  todo[depth++] = {0, 0, std::uint32_t(order_.size())};
  while (depth > 0) {
    const Range range = todo[--depth];
    const Node& node = nodes_[range.node];
    if (node.alive == 0 || node.lower.x > upper.x || node.upper.x < lower.x || node.lower.y > upper.y ||
        node.upper.y < lower.y || beyond(a, b, node.lower, node.upper) || beyond(b, c, node.lower, node.upper) ||
        beyond(c, a, node.lower, node.upper))
      continue;
    if (range.last - range.first > kLeaf) {
      todo[depth++] = left(range);
      todo[depth++] = right(range);
      continue;
    }
    for (std::uint32_t i = range.first; i != range.last; ++i) {
      const Point2& p = points_[order_[i]];
      if (present_[i] && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0 && p != a && p != b && p != c)
        return true;
    }
  }
  return false;
}

}  // namespace grelha
