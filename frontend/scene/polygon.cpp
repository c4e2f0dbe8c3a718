#include "frontend/scene/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "frontend/scene/double3.hpp"
#include "frontend/scene/flat_triangles.hpp"
#include "frontend/scene/polygon_plane.hpp"

namespace grelha {
namespace {

/// How often every corner left may be asked again before a corner is taken by force. One pass is
/// enough for a simple outline but for rare rings of touching corners.
constexpr int kFullPasses = 8;
/// Outlines of so many corners are cut evenly: neighbours of an ear wait for the next pass, so that
/// triangles grow by doubling and stay short. Ears in turn, or a fan, would all reach across, and
/// stand in thousands of a grid's cells.
constexpr std::uint32_t kTreeMin = 1024;
/// Nodes of the tree that an ear's test looks at, in turn, before it looks at all. In a star of a
/// million uneven spikes an ear's triangle, long and thin, meets hundreds, and holds no corner.
constexpr std::uint32_t kMaxLooks[] = {0, 64};
/// Corners that a forced clip searches for one with area; bounds the work on hopeless outlines.
constexpr int kForcedLook = 64;

/// The sides of outlines with so few corners are compared in pairs; for more, a sweep is faster.
constexpr std::size_t kSmallPolygon = 16;

double component(const Float3& p, int axis) {
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

/// Returns true if two sides that are not neighbours have a point in common.
bool intersect_edges(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
  const auto apart = [](double p, double q, double r, double s) {
    return std::max(p, q) < std::min(r, s) || std::max(r, s) < std::min(p, q);
  };
  return !apart(a.x, b.x, c.x, d.x) && !apart(a.y, b.y, c.y, d.y) &&
         exact_turn(a, b, c) * exact_turn(a, b, d) <= 0 &&
         exact_turn(c, d, a) * exact_turn(c, d, b) <= 0;
}

/// Returns true if two adjacent sides overlap.
bool is_spike(const Point2& a, const Point2& b, const Point2& c) {
  return exact_turn(a, b, c) == 0 && (a.x - b.x) * (c.x - b.x) + (a.y - b.y) * (c.y - b.y) > 0;
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
  even_ = corner_points.size() >= kTreeMin;
  if (!even_ && convex()) {
    for (std::uint32_t i = 2; i < corner_points.size(); ++i)
      triangles.push_back({0, i - 1, i});
    return Result::kCut;
  }
  return cut_up(corner_points, triangles);
}

PolygonSplitter::Result PolygonSplitter::cut_up(std::span<const Float3> corner_points,
                                                std::vector<Triangle>& triangles) {
  for (bool again = false;; again = true) {
    if (is_simple()) {
      clip(triangles);
      return Result::kCut;
    }
    Outline outline(points_);
    const Outline::State state = outline.arrange();
    // the normal sum of an outline that crosses itself belongs to no particular plane
    if (!again && state != Outline::State::kSimple)
      normal_ = larger_normal(corner_points, normal_);
    if (again || state == Outline::State::kSimple || !project(corner_points))
      return fill(corner_points, outline, state, triangles);
  }
}

/// An outline that touches itself, and nowhere winds twice round its inside, is clipped like a
/// simple one.
PolygonSplitter::Result PolygonSplitter::fill(std::span<const Float3> corner_points,
                                              const Outline& outline,
                                              Outline::State state,
                                              std::vector<Triangle>& triangles) {
  if (state == Outline::State::kCutLimit)
    return Result::kCutLimit;
  const EvenOddFill& fill = outline.fill();
  if (!fill.is_crossed) {
    const std::size_t before = triangles.size();
    clip(triangles);
    if (state == Outline::State::kSimple || !forced_)
      return Result::kCut;
    triangles.resize(before);
  }
  record_intersections(corner_points, outline);
  std::vector<Triangle> filled = fill.triangles;
  fix_flat_triangles(points_, filled);
  triangles.insert(triangles.end(), filled.begin(), filled.end());
  return fill.is_crossed ? Result::kFilled : Result::kCut;
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

/// Clips ears until nothing is left.
void PolygonSplitter::clip(std::vector<Triangle>& triangles) {
  forced_ = false;
  if (even_)
    for (const std::uint32_t looks : kMaxLooks)
      if (clip_fast(looks, triangles))
        return;
  looks_ = PointTree::kAllNodes;
  link_vertices();
  build_tree();
  clip_ears(triangles);
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
bool PolygonSplitter::convex() const {
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

/// Returns true if the outline has few corners, and its sides meet only there.
bool PolygonSplitter::is_simple() const {
  if (points_.size() > kSmallPolygon)
    return false;
  std::array<Point2, kSmallPolygon + 1> ring;
  std::size_t n = 0;
  for (const Point2& p : points_)
    if (n == 0 || ring[n - 1] != p)
      ring[n++] = p;
  while (n > 1 && ring[n - 1] == ring[0])
    --n;
  const auto at = [&](std::size_t i) -> const Point2& { return ring[i % n]; };
  for (std::size_t i = 0; i < n; ++i) {
    if (is_spike(at(i), at(i + 1), at(i + 2)))
      return false;
    for (std::size_t j = i + 2; j < n && j < n + i - 1; ++j)
      if (intersect_edges(at(i), at(i + 1), at(j), at(j + 1)))
        return false;
  }
  return true;
}

/// Links the corners to a ring, without corners that repeat the one before.
void PolygonSplitter::link_vertices() {
  const auto n = std::uint32_t(points_.size());
  previous_.resize(n);
  following_.resize(n);
  gone_.assign(n, 0);
  queued_.assign(n, 0);
  waits_.assign(n, 0);
  candidates_.clear();
  for (std::uint32_t i = 0; i < n; ++i)
    if (candidates_.empty() || points_[i] != points_[candidates_.back()])
      candidates_.push_back(i);
  while (candidates_.size() > 1 && points_[candidates_.back()] == points_[candidates_.front()])
    candidates_.pop_back();
  left_ = std::uint32_t(candidates_.size());
  start_ = candidates_.front();
  for (std::uint32_t k = 0; k < left_; ++k) {
    const std::uint32_t here = candidates_[k], after = candidates_[k + 1 == left_ ? 0 : k + 1];
    following_[here] = after;
    previous_[after] = here;
    queued_[here] = 1;
  }
}

void PolygonSplitter::build_tree() {
  in_tree_.assign(points_.size(), 0);
  if (looks_ == 0)
    return;
  std::vector<std::uint32_t> bent;
  for (std::uint32_t i = 0, corner = start_; i < left_; ++i, corner = following_[corner]) {
    if (turn(corner) > 0)
      continue;
    bent.push_back(corner);
    in_tree_[corner] = 1;
  }
  tree_.build(points_, bent);
}

double PolygonSplitter::turn(std::uint32_t corner) const {
  return grelha::turn(points_[previous_[corner]], points_[corner], points_[following_[corner]]);
}

bool PolygonSplitter::blocked(std::uint32_t corner) const {
  return tree_.any_in(
      points_[previous_[corner]], points_[corner], points_[following_[corner]], looks_);
}

void PolygonSplitter::queue(std::uint32_t corner) {
  if (!std::exchange(queued_[corner], 1))
    next_candidates_.push_back(corner);
}

void PolygonSplitter::take_queue() {
  candidates_.swap(next_candidates_);
  next_candidates_.clear();
  for (const std::uint32_t corner : candidates_)
    waits_[corner] = 0;
  if (even_ && looks_ != 0 && tree_.is_thin())
    build_tree();
}

/// Removes a corner from the ring. Its neighbours may have become convex and are tested again.
void PolygonSplitter::remove(std::uint32_t corner) {
  const std::uint32_t before = previous_[corner], after = following_[corner];
  following_[before] = after;
  previous_[after] = before;
  gone_[corner] = 1;
  --left_;
  if (start_ == corner)
    start_ = after;
  if (in_tree_[corner])
    tree_.remove(corner);
  for (const std::uint32_t neighbour : {before, after}) {
    if (in_tree_[neighbour] && turn(neighbour) > 0) {
      tree_.remove(neighbour);
      in_tree_[neighbour] = 0;
    }
    queue(neighbour);
    waits_[neighbour] = even_;
  }
}

bool PolygonSplitter::try_clip(std::uint32_t corner, std::vector<Triangle>& triangles) {
  const std::uint32_t before = previous_[corner], after = following_[corner];
  const Point2 &a = points_[before], &b = points_[corner], &c = points_[after];
  const double area = turn(corner);
  if (area < 0)
    return false;
  if (area ==
      // a spike or a repeated corner goes without a trace; a flat corner stays, it bounds its
      // neighbours' ears
      0) {
    const bool spike =
        b == a || b == c || (a.x - b.x) * (c.x - b.x) + (a.y - b.y) * (c.y - b.y) > 0;
    if (!spike)
      return false;
  } else {
    if (blocked(corner))
      return false;
    triangles.push_back({before, corner, after});
  }
  remove(corner);
  return true;
}

/// Clips corners that turn left, and searches their triangles for other corners only up to `looks`
/// nodes. Undoes everything and returns false if that was not enough. Clipping keeps the sum of
/// winding numbers: triangles that all turn left cover each point as often as the outline goes
/// round it, so a simple outline's inside once. A corner missed inside a triangle leaves a place
/// that is covered twice. The rest would have to make up for it, and cannot end in a triangle that
/// turns left.
bool PolygonSplitter::clip_fast(std::uint32_t looks, std::vector<Triangle>& triangles) {
  const std::size_t before = triangles.size();
  looks_ = looks;
  link_vertices();
  build_tree();
  clip_candidates(triangles);
  const bool whole = left_ == 3 && turn(start_) > 0;
  if (whole)
    triangles.push_back({previous_[start_], start_, following_[start_]});
  else
    triangles.resize(before);
  return whole;
}

/// No ear is left, so the outline crosses or touches itself: clip some corner all the same, so that
/// clipping ends.
void PolygonSplitter::force_clip(std::vector<Triangle>& triangles) {
  forced_ = true;
  std::uint32_t corner = start_;
  for (int i = 0; i < kForcedLook && !(turn(corner) > 0); ++i)
    corner = following_[corner];
  if (turn(corner) > 0)
    triangles.push_back({previous_[corner], corner, following_[corner]});
  start_ = following_[corner];
  remove(corner);
}

/// Tests corners until no candidate is left. Returns true if one was clipped.
bool PolygonSplitter::clip_candidates(std::vector<Triangle>& triangles) {
  bool clipped = false;
  next_candidates_.clear();
  while (left_ > 3 && !candidates_.empty()) {
    for (const std::uint32_t corner : candidates_) {
      queued_[corner] = 0;
      if (gone_[corner] || left_ <= 3)
        continue;
      if (waits_[corner]) {
        queue(corner);
        continue;
      }
      clipped = try_clip(corner, triangles) || clipped;
    }
    take_queue();
  }
  return clipped;
}

void PolygonSplitter::clip_ears(std::vector<Triangle>& triangles) {
  int full_passes = 1;
  while (left_ > 3) {
    const bool clipped = clip_candidates(triangles);
    if (left_ <= 3)
      break;
    if (clipped && full_passes++ < kFullPasses) {
      for (std::uint32_t i = 0, corner = start_; i < left_; ++i, corner = following_[corner])
        queue(corner);
    } else {
      force_clip(triangles);
    }
    take_queue();
  }
  const double last = left_ == 3 ? turn(start_) : 0;
  if (last > 0)
    triangles.push_back({previous_[start_], start_, following_[start_]});
  forced_ = forced_ || last < 0;
}

}  // namespace grelha
