#include "frontend/scene/delaunay.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

namespace grelha {
namespace {

using Vertices = std::array<std::uint32_t, 3>;

constexpr std::uint32_t kNoTwin = 0xFFFFFFFF;
/// Flips a triangle. A sweep's triangles take about one; outlines made for it could take n.
constexpr std::size_t kMostFlips = 16;
/// Corners so near one circle keep their side, whatever the rounding of the angles.
constexpr double kOnCircle = 1e-12;

/// Triangles with half-edges: number 3 t + k is the side of triangle t from its corner k on.
class Flipper {
 public:
  Flipper(std::span<const Point2> points, std::vector<Vertices>& triangles)
      : points_(points), triangles_(triangles), twin_(3 * triangles.size(), kNoTwin) {}

  void run() {
    pair_sides();
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      record_flat(t);
    while (!flat_.empty()) {
      const std::uint32_t longest = flat_.top().second;
      flat_.pop();
      fix(longest);
    }
    for (std::uint32_t side = 0; side < twin_.size(); ++side)
      if (twin_[side] < side)
        unchecked_.push_back(side);
    std::size_t left = kMostFlips * triangles_.size();
    while (!unchecked_.empty() && left > 0) {
      const std::uint32_t side = unchecked_.back();
      unchecked_.pop_back();
      if (!is_delaunay(side) && flip(side))
        --left;
    }
  }

 private:
  static std::uint32_t next(std::uint32_t side) { return side % 3 == 2 ? side - 2 : side + 1; }
  std::uint32_t corner(std::uint32_t side) const { return triangles_[side / 3][side % 3]; }
  std::uint32_t opposite(std::uint32_t side) const { return corner(next(next(side))); }

  void pair_sides() {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> sides;
    for (std::uint32_t side = 0; side < twin_.size(); ++side) {
      const std::uint32_t a = corner(side), b = corner(next(side));
      sides.emplace_back(std::uint64_t{std::min(a, b)} << 32 | std::max(a, b), side);
    }
    std::ranges::sort(sides);
    for (std::size_t i = 1; i < sides.size(); ++i)
      if (sides[i].first == sides[i - 1].first &&
          corner(sides[i].second) != corner(sides[i - 1].second))
        link(sides[i].second, sides[i - 1].second);
  }
  void link(std::uint32_t side, std::uint32_t twin) {
    twin_[side] = twin;
    if (twin != kNoTwin)
      twin_[twin] = side;
  }

  int turn_of(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return exact_turn(points_[a], points_[b], points_[c]);
  }
  double length(std::uint32_t side) const {
    const Point2 &a = points_[corner(side)], &b = points_[corner(next(side))];
    return (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
  }
  bool is_flat(std::uint32_t t) const {
    const auto& [a, b, c] = triangles_[t];
    return turn_of(a, b, c) == 0;
  }
  std::uint32_t longest_side(std::uint32_t t) const {
    std::uint32_t best = 3 * t;
    for (const std::uint32_t side : {3 * t + 1, 3 * t + 2})
      if (length(side) > length(best))
        best = side;
    return best;
  }
  /// A triangle with two corners at one position leaves no gap for rays.
  void record_flat(std::uint32_t t) {
    if (!is_flat(t))
      return;
    const std::uint32_t side = longest_side(t);
    if (length(next(side)) > 0 && length(next(next(side))) > 0)
      flat_.push({length(side), t});
  }
  void fix(std::uint32_t flat) {
    if (!is_flat(flat))
      return;  // it was the neighbour of a longer one
    const std::uint32_t side = longest_side(flat);
    if (twin_[side] == kNoTwin)
      return;  // the side is the polygon's own
    const std::uint32_t neighbour = twin_[side] / 3;
    if (!flip(side))
      return;
    record_flat(flat);
    record_flat(neighbour);
  }

  /// Returns true if the angles opposite a side sum to at most pi, or if the side is the only
  /// diagonal of its two triangles.
  bool is_delaunay(std::uint32_t side) const {
    const std::uint32_t twin = twin_[side];
    if (twin == kNoTwin)
      return true;
    const std::uint32_t p = corner(side), q = corner(twin), r = opposite(side), s = opposite(twin);
    const auto [sine1, cosine1] = angle(r, p, q);
    const auto [sine2, cosine2] = angle(s, q, p);
    const double product1 = sine1 * cosine2, product2 = sine2 * cosine1;
    return product1 + product2 >= -kOnCircle * (std::abs(product1) + std::abs(product2)) ||
           turn_of(r, p, s) <= 0 || turn_of(s, q, r) <= 0;
  }
  struct Angle {
    double sine, cosine;  ///< each by the product of the lengths
  };
  Angle angle(std::uint32_t at, std::uint32_t from, std::uint32_t to) const {
    const Point2 &a = points_[at], &b = points_[from], &c = points_[to];
    return {turn(a, b, c), (b.x - a.x) * (c.x - a.x) + (b.y - a.y) * (c.y - a.y)};
  }

  /// Exchanges a side for the other diagonal of both triangles. Returns false if there is none.
  bool flip(std::uint32_t side) {
    const std::uint32_t twin = twin_[side];
    const std::uint32_t p = corner(side), q = corner(twin), r = opposite(side), s = opposite(twin);
    if (r == s)
      return false;
    const std::uint32_t outer[] = {
        twin_[next(next(side))], twin_[next(twin)], twin_[next(next(twin))], twin_[next(side)]};
    const std::uint32_t first = side / 3 * 3, second = twin / 3 * 3;
    triangles_[first / 3] = {r, p, s};
    triangles_[second / 3] = {s, q, r};
    const std::uint32_t sides[] = {first, first + 1, second, second + 1};
    for (int i = 0; i < 4; ++i)
      link(sides[i], outer[i]);
    link(first + 2, second + 2);
    unchecked_.insert(unchecked_.end(), sides, sides + 4);
    return true;
  }

  std::span<const Point2> points_;
  std::vector<Vertices>& triangles_;
  std::vector<std::uint32_t> twin_;                             ///< [sides] of the neighbour
  std::priority_queue<std::pair<double, std::uint32_t>> flat_;  ///< the longest first
  std::vector<std::uint32_t> unchecked_;                        ///< sides
};

}  // namespace

void make_delaunay(std::span<const Point2> points, std::vector<Vertices>& triangles) {
  Flipper(points, triangles).run();
}

}  // namespace grelha
