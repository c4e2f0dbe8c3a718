#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <memory_resource>
#include <optional>
#include <set>
#include <vector>

namespace grelha {

struct Point2 {
  double x = 0, y = 0;
  bool operator==(const Point2&) const = default;
};

/// The order in which a line sweeps over the plane: by x and, where x is equal, by y.
inline bool swept_before(const Point2& a, const Point2& b) {
  return a.x < b.x || (a.x == b.x && a.y < b.y);
}

/// Twice the signed area of a, b, c; positive when they turn left. Exact in sign for float
/// coordinates of like size.
inline double turn(const Point2& a, const Point2& b, const Point2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The sign of the same by the sum of its six products, without rounding.
int exactly_summed_turn(const Point2& a, const Point2& b, const Point2& c);

/// The sign of the same, exact for all doubles whose products neither over- nor underflow: 1, 0 or
/// -1. Adds the products without rounding if rounding could change the sign (Shewchuk 1997).
inline int exact_turn(const Point2& a, const Point2& b, const Point2& c) {
  constexpr double kRounding = 3.3306690738754716e-16;  // (3 + 16u) u of the two products' sizes
  const double left = (b.x - a.x) * (c.y - a.y), right = (b.y - a.y) * (c.x - a.x);
  const double difference = left - right, bound = kRounding * (std::abs(left) + std::abs(right));
  if (difference > bound)
    return 1;
  return difference < -bound ? -1 : exactly_summed_turn(a, b, c);
}

/// A piece of an outline's side between two points, the left one swept first.
struct OutlineEdge {
  std::uint32_t left = 0, right = 0;
  std::uint32_t side = 0;    ///< of the outline: from corner `side` to the next
  std::int32_t winding = 0;  ///< added to an outline's winding number from below the edge to above
};

/// The edges that a vertical line meets, from below upwards, on its way over an arrangement of
/// edges (Shamos and Hoey 1976).
class SweepLine {
 public:
  /// An edge with its ends, which are looked at more often than anything else. It may be exchanged
  /// for one at the same position on the line.
  struct Slot {
    mutable std::uint32_t edge;
    mutable Point2 left, right;
    int side_of(const Point2& p) const { return exact_turn(left, right, p); }
    /// Between its ends, as the sweep goes.
    bool spans_point(const Point2& p) const {
      return swept_before(left, p) && swept_before(p, right);
    }
    bool contains_point(const Point2& p) const { return spans_point(p) && side_of(p) == 0; }
  };
  /// Returns whether two edges have a point in common that is not an end of both.
  static bool intersect_edges(const Slot& a, const Slot& b) {
    const auto [a_low, a_high] = std::minmax(a.left.y, a.right.y);
    const auto [b_low, b_high] = std::minmax(b.left.y, b.right.y);
    if (a_high < b_low || b_high < a_low)
      return false;
    const int side1 = a.side_of(b.left), side2 = a.side_of(b.right);
    if (side1 * side2 > 0)
      return false;
    const int side3 = b.side_of(a.left), side4 = b.side_of(a.right);
    if (side1 * side2 < 0 && side3 * side4 < 0)
      return true;
    return (side1 == 0 && a.spans_point(b.left)) || (side2 == 0 && a.spans_point(b.right)) ||
           (side3 == 0 && b.spans_point(a.left)) || (side4 == 0 && b.spans_point(a.right));
  }

 private:
  struct Below {
    using is_transparent = void;
    bool operator()(const Slot& a, const Slot& b) const {
      int side = 0;
      if (swept_before(b.left, a.left))
        side = -b.side_of(a.left);
      else if (a.left != b.left)
        side = a.side_of(b.left);
      if (side == 0)
        side = a.side_of(b.right);
      return side != 0 ? side > 0 : a.edge < b.edge;
    }
    /// Returns true if an edge passes below a point on the line.
    bool operator()(const Slot& a, const Point2& p) const { return a.side_of(p) > 0; }
  };

 public:
  using Iterator = std::pmr::multiset<Slot, Below>::iterator;

  SweepLine(const std::vector<Point2>& points, const std::vector<OutlineEdge>& edges)
      : points_(points), edges_(edges) {}

  /// Right below `above`, which is found by a search where that is not its position.
  Iterator insert(Iterator above, std::uint32_t edge) {
    return slots_.insert(above, slot_of(edge));
  }
  Iterator erase(Iterator at) { return slots_.erase(at); }
  /// The position is another edge's from now on.
  void replace_edge(Iterator at, std::uint32_t edge) const {
    const Slot slot = slot_of(edge);
    at->edge = edge;
    at->left = slot.left;
    at->right = slot.right;
  }
  Iterator first_above(const Point2& p) const { return slots_.lower_bound(p); }
  Iterator begin() const { return slots_.begin(); }
  Iterator end() const { return slots_.end(); }

 private:
  Slot slot_of(std::uint32_t edge) const {
    return {edge, points_[edges_[edge].left], points_[edges_[edge].right]};
  }

  const std::vector<Point2>& points_;
  const std::vector<OutlineEdge>& edges_;
  std::pmr::unsynchronized_pool_resource memory_;
  std::pmr::multiset<Slot, Below> slots_{&memory_};
};

/// The points of an arrangement in the order of the sweep, each with the edges that end there and
/// those that begin.
class SweepEvents {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;

  SweepEvents(std::size_t points, const std::vector<OutlineEdge>& edges)
      : first_ending_(points, kNone), first_start_(points, kNone) {
    for (std::uint32_t e = 0; e < edges.size(); ++e)
      add(e, edges[e]);
  }
  void add(std::uint32_t e, const OutlineEdge& edge) {
    add_ending(e, edge.right);
    add_start(e, edge.left);
  }
  void add_ending(std::uint32_t e, std::uint32_t point) {
    push(next_ending_, first_ending_, e, point);
  }
  void add_start(std::uint32_t e, std::uint32_t point) {
    push(next_start_, first_start_, e, point);
  }
  void add_point() {
    first_ending_.push_back(kNone);
    first_start_.push_back(kNone);
  }

  std::uint32_t first_ending(std::uint32_t point) const { return first_ending_[point]; }
  std::uint32_t first_start(std::uint32_t point) const { return first_start_[point]; }
  std::uint32_t next_ending(std::uint32_t edge) const { return next_ending_[edge]; }
  std::uint32_t next_start(std::uint32_t edge) const { return next_start_[edge]; }
  /// Returns true if one edge ends at the point and one begins, which takes its place on the line.
  bool goes_on(std::uint32_t point) const {
    const std::uint32_t a = first_ending_[point], b = first_start_[point];
    return a != kNone && b != kNone && next_ending_[a] == kNone && next_start_[b] == kNone;
  }

 private:
  using List = std::vector<std::uint32_t>;
  static void push(List& next, List& first, std::uint32_t edge, std::uint32_t point) {
    if (next.size() <= edge)
      next.resize(edge + 1, kNone);
    next[edge] = first[point];
    first[point] = edge;
  }

  List first_ending_, first_start_;  ///< [points]
  List next_ending_, next_start_;    ///< [edges]
};

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
