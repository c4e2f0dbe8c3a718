#include "frontend/scene/polygon.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "frontend/scene/double3.hpp"
#include "frontend/scene/sweep_line.hpp"

namespace grelha {
namespace {

double squared(const Double3& a) {
  return dot(a, a);
}

/// The normal, with twice the area as its length, of the first corner, the one farthest from it,
/// and the one farthest from both.
Double3 normal_of_three(std::span<const Float3> corner_points) {
  Double3 extent{}, normal{};
  for (const Float3& p : corner_points)
    if (const Double3 edge = difference(p, corner_points[0]); squared(edge) > squared(extent))
      extent = edge;
  for (const Float3& p : corner_points)
    if (const Double3 n = cross(extent, difference(p, corner_points[0]));
        squared(n) > squared(normal))
      normal = n;
  return normal;
}

}  // namespace

/// Sums over differences to the first corner: those of nearby floats are exact.
Double3 newell_sum(std::span<const Float3> corner_points) {
  Double3 sum{};
  const Float3 o = corner_points[0];
  Double3 p = difference(corner_points[1], o);
  for (std::size_t i = 2; i < corner_points.size(); ++i) {
    const Double3 q = difference(corner_points[i], o), term = cross(p, q);
    for (std::size_t k = 0; k < 3; ++k)
      sum[k] += term[k];
    p = q;
  }
  return sum;
}

Double3 larger_normal(std::span<const Float3> corner_points, const Double3& sum) {
  Double3 other = normal_of_three(corner_points);
  if (!(squared(other) > squared(sum)))
    return sum;
  const Double3 first = cross(difference(corner_points[1], corner_points[0]),
                              difference(corner_points[2], corner_points[1]));
  const double product = dot(other, sum);
  if (product < 0 || (product == 0 && dot(other, first) < 0))
    other = {-other[0], -other[1], -other[2]};
  return other;
}

/// If parts cancel, the rest may be rounding error, or the side view of a bent outline. Then it is
/// much smaller than the normal of a large triangle, and points elsewhere. For a plane outline both
/// are the same.
Double3 polygon_normal(std::span<const Float3> corner_points) {
  constexpr double kSmaller = 2, kCosine = .9;
  const Double3 sum = newell_sum(corner_points);
  if (corner_points.size() == 3)
    return sum;
  double extent = 0;
  for (const Float3& p : corner_points)
    extent = std::max(extent, squared(difference(p, corner_points[0])));
  if (kSmaller * kSmaller * squared(sum) >= extent * extent)
    return sum;  // no triangle is so much larger
  const Double3 other = larger_normal(corner_points, sum);
  const double product = dot(other, sum), size = squared(other);
  const bool is_lost = size > kSmaller * kSmaller * squared(sum) &&
                       product * product <= kCosine * kCosine * size * squared(sum);
  return is_lost ? other : sum;
}

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

/// Flips sides that two triangles share until the triangulation is Delaunay within its outline
/// (Lawson 1977): its least angles are as large as they can be, and few triangles are slivers. The
/// number of flips is bounded by a multiple of the number of triangles.
///
/// Triangles without area go first. The longest side of such a triangle has a corner between its
/// ends, and rays could slip through there. Those that still have no area can then be dropped.
void make_delaunay(std::span<const Point2> points, std::vector<Vertices>& triangles) {
  Flipper(points, triangles).run();
}

double component(const Float3& p, int axis) {
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

}  // namespace

Float3 at_crossing(std::span<const Float3> of_corners, const SideCrossing& crossing) {
  Double3 sum{};
  for (const auto& [corner, share] : crossing) {
    const Float3 &a = of_corners[corner], &b = of_corners[(corner + 1) % of_corners.size()];
    const Double3 edge = difference(b, a);
    sum[0] += a.x + share * edge[0];
    sum[1] += a.y + share * edge[1];
    sum[2] += a.z + share * edge[2];
  }
  return {float(sum[0] / 2), float(sum[1] / 2), float(sum[2] / 2)};
}

PolygonSplitter::Result PolygonSplitter::cut(std::span<const Float3> corner_points,
                                             std::vector<Triangle>& triangles) {
  normal_ = {};
  intersections_.clear();
  if (corner_points.size() < 3)
    return Result::kNoArea;
  normal_ = polygon_normal(corner_points);
  if (is_zero(normal_))  // there is no direction to shade by
    return Result::kNoArea;
  if (corner_points.size() == 3) {
    triangles.push_back({0, 1, 2});
    return Result::kCut;
  }
  points_.clear();
  project(corner_points);
  if (!is_convex())
    return fill(corner_points, triangles);
  for (std::uint32_t i = 2; i < corner_points.size(); ++i)
    triangles.push_back({0, i - 1, i});
  return Result::kCut;
}

PolygonSplitter::Result PolygonSplitter::fill(std::span<const Float3> corner_points,
                                              std::vector<Triangle>& triangles) {
  Outline outline(points_);
  Outline::State state = outline.arrange();
  if (state != Outline::State::kSimple) {
    // the normal sum of an outline that crosses itself belongs to no particular plane
    normal_ = larger_normal(corner_points, normal_);
    if (project(corner_points)) {
      outline = Outline(points_);
      state = outline.arrange();
    }
  }
  if (state == Outline::State::kCutLimit)
    return Result::kCutLimit;
  record_intersections(corner_points, outline);
  EvenOddFill filled = outline.fill();
  make_delaunay(points_, filled.triangles);
  triangles.insert(triangles.end(), filled.triangles.begin(), filled.triangles.end());
  if (filled.is_crossed)
    return Result::kFilled;
  if (filled.triangles.empty())
    return Result::kNoArea;
  return is_whole(corner_points, filled.triangles) ? Result::kCut : Result::kFolded;
}

/// Surfaces of one boundary have one sum of areas along normals. Where the outline is bent by a
/// right angle or more, sides that cancel in the plane may bound parts that are lost.
bool PolygonSplitter::is_whole(std::span<const Float3> corner_points,
                               std::span<const Triangle> triangles) const {
  constexpr double kShare = 1e-3;  // far above rounding, and too little to see
  const auto at = [&](std::uint32_t i) {
    return i < corner_points.size()
               ? corner_points[i]
               : at_crossing(corner_points, intersections_[i - corner_points.size()]);
  };
  Double3 missing = newell_sum(corner_points);
  double area = 0;
  for (const auto& [a, b, c] : triangles) {
    const Double3 normal = cross(difference(at(b), at(a)), difference(at(c), at(a)));
    for (std::size_t k = 0; k < 3; ++k)
      missing[k] -= normal[k];
    area += length(normal);
  }
  return length(missing) <= kShare * area;
}

void PolygonSplitter::record_intersections(std::span<const Float3> corner_points,
                                           const Outline& outline) {
  for (const OutlineCrossing& crossing : outline.intersections()) {
    const auto on_side = [&](std::uint32_t side) {
      return PositionOnSide{side, outline.share_of(side, crossing.point)};
    };
    intersections_.push_back({on_side(crossing.sides[0]), on_side(crossing.sides[1])});
    points_.push_back(projected(at_crossing(corner_points, intersections_.back())));
  }
}

/// Along the normal's largest axis. Returns whether that is another way than before.
bool PolygonSplitter::project(std::span<const Float3> corner_points) {
  int axis = std::abs(normal_[1]) > std::abs(normal_[0]) ? 1 : 0;
  if (std::abs(normal_[2]) > std::abs(normal_[std::size_t(axis)]))
    axis = 2;
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  // seen from behind: mirror, so that it turns left
  if (normal_[std::size_t(axis)] < 0)
    std::swap(u, v);
  if (points_.size() == corner_points.size() && std::exchange(axes_, {u, v}) == std::array{u, v})
    return false;
  axes_ = {u, v};
  points_.resize(corner_points.size());
  for (std::size_t i = 0; i < corner_points.size(); ++i)
    points_[i] = projected(corner_points[i]);
  return true;
}

Point2 PolygonSplitter::projected(const Float3& p) const {
  return {component(p, axes_[0]), component(p, axes_[1])};
}

/// Returns true if every corner turns left and the outline winds once: it has one leftmost and one
/// rightmost corner.
bool PolygonSplitter::is_convex() const {
  const std::size_t n = points_.size();
  int turns_back = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 &a = points_[i], &b = points_[(i + 1) % n], &c = points_[(i + 2) % n];
    if (!(grelha::turn(a, b, c) > 0))
      return false;
    turns_back += swept_before(a, b) != swept_before(b, c) ? 1 : 0;
  }
  return turns_back == 2;
}

}  // namespace grelha
