#include "frontend/scene/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "frontend/scene/double3.hpp"
#include "frontend/scene/delaunay.hpp"
#include "frontend/scene/polygon_plane.hpp"

namespace grelha {
namespace {

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
