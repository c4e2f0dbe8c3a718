#include "frontend/scene/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grelha {
namespace {

/// How often every corner left may be asked again before a corner is taken by force. One pass is
/// enough for a simple outline but for rare rings of touching corners.
constexpr int kFullPasses = 8;
/// Outlines of so many corners are cut evenly: neighbours of an ear wait for the next pass, so that
/// triangles grow by doubling and stay short. Ears in turn, or a fan, would all reach across, and
/// stand in thousands of a grid's cells.
constexpr std::uint32_t kMany = 1024;
/// Nodes of the tree that an ear's test looks at, in turn, before it looks at all. In a star of a
/// million uneven spikes an ear's triangle, long and thin, meets hundreds, and holds no corner.
constexpr std::uint32_t kHopefulLooks[] = {0, 64};
/// How far a forced clip looks for a corner that at least has area; bounds the work on hopeless
/// outlines.
constexpr int kForcedLook = 64;

double component(const Float3& p, int axis) {
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

}  // namespace

bool PolygonCutter::cut(std::span<const Float3> corners, std::vector<Triangle>& triangles) {
  normal_ = {};
  if (corners.size() < 3)
    return false;
  find_normal(corners);
  // What vanishes as floats has no direction to shade by.
  if (float(normal_[0]) == 0 && float(normal_[1]) == 0 && float(normal_[2]) == 0)
    return false;
  if (corners.size() == 3) {
    triangles.push_back({0, 1, 2});
    return true;
  }
  project(corners);
  even_ = corners.size() >= kMany;
  if (!even_ && convex()) {
    for (std::uint32_t i = 2; i < corners.size(); ++i)
      triangles.push_back({0, i - 1, i});
    return true;
  }
  if (even_)
    for (const std::uint32_t looks : kHopefulLooks)
      if (clip_hopefully(looks, triangles))
        return true;
  looks_ = PointTree::kAllNodes;
  link_corners();
  plant_tree();
  clip_ears(triangles);
  return true;
}

/// Sums over differences to the first corner: those of nearby floats are exact, so that corners on
/// one line give zero.
void PolygonCutter::find_normal(std::span<const Float3> corners) {
  const Float3 o = corners[0];
  std::array<double, 3> p{
      double(corners[1].x) - o.x, double(corners[1].y) - o.y, double(corners[1].z) - o.z};
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const std::array<double, 3> q{
        double(corners[i].x) - o.x, double(corners[i].y) - o.y, double(corners[i].z) - o.z};
    normal_[0] += p[1] * q[2] - p[2] * q[1];
    normal_[1] += p[2] * q[0] - p[0] * q[2];
    normal_[2] += p[0] * q[1] - p[1] * q[0];
    p = q;
  }
}

void PolygonCutter::project(std::span<const Float3> corners) {
  int axis = std::abs(normal_[1]) > std::abs(normal_[0]) ? 1 : 0;
  if (std::abs(normal_[2]) > std::abs(normal_[std::size_t(axis)]))
    axis = 2;
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  // seen from behind: mirror, so that it turns left
  if (normal_[std::size_t(axis)] < 0)
    std::swap(u, v);
  points_.resize(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i)
    points_[i] = {component(corners[i], u), component(corners[i], v)};
}

/// Every corner turns left. An outline that does so while it goes round more than once crosses
/// itself, and then a fan is as good as anything.
bool PolygonCutter::convex() const {
  const std::size_t n = points_.size();
  for (std::size_t i = 0; i < n; ++i)
    if (!(grelha::turn(points_[i], points_[(i + 1) % n], points_[(i + 2) % n]) > 0))
      return false;
  return true;
}

/// A ring without corners that repeat the one before.
void PolygonCutter::link_corners() {
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

void PolygonCutter::plant_tree() {
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

double PolygonCutter::turn(std::uint32_t corner) const {
  return grelha::turn(points_[previous_[corner]], points_[corner], points_[following_[corner]]);
}

bool PolygonCutter::blocked(std::uint32_t corner) const {
  return tree_.any_in(
      points_[previous_[corner]], points_[corner], points_[following_[corner]], looks_);
}

void PolygonCutter::queue(std::uint32_t corner) {
  if (!std::exchange(queued_[corner], 1))
    next_candidates_.push_back(corner);
}

void PolygonCutter::take_queue() {
  candidates_.swap(next_candidates_);
  next_candidates_.clear();
  for (const std::uint32_t corner : candidates_)
    waits_[corner] = 0;
  if (even_ && looks_ != 0 && tree_.is_thin())
    plant_tree();
}

/// Takes a corner out of the ring. Its neighbours may have become convex and get another turn.
void PolygonCutter::remove(std::uint32_t corner) {
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

bool PolygonCutter::try_clip(std::uint32_t corner, std::vector<Triangle>& triangles) {
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

/// Clips corners that turn left and looks for others in their triangles only so far; takes all back
/// and is false when that was not enough. Clipping keeps the sum of winding numbers: triangles that
/// all turn left cover each point as often as the outline goes round it, so a simple outline's
/// inside once. A corner missed inside a triangle leaves a place that is covered twice. The rest
/// would have to make up for it, and cannot end in a triangle that turns left.
bool PolygonCutter::clip_hopefully(std::uint32_t looks, std::vector<Triangle>& triangles) {
  const std::size_t before = triangles.size();
  looks_ = looks;
  link_corners();
  plant_tree();
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
void PolygonCutter::force_clip(std::vector<Triangle>& triangles) {
  std::uint32_t corner = start_;
  for (int i = 0; i < kForcedLook && !(turn(corner) > 0); ++i)
    corner = following_[corner];
  if (turn(corner) > 0)
    triangles.push_back({previous_[corner], corner, following_[corner]});
  start_ = following_[corner];
  remove(corner);
}

/// Asks corners until none is left to ask. True when one was clipped.
bool PolygonCutter::clip_candidates(std::vector<Triangle>& triangles) {
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

void PolygonCutter::clip_ears(std::vector<Triangle>& triangles) {
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
  if (left_ == 3 && turn(start_) > 0)
    triangles.push_back({previous_[start_], start_, following_[start_]});
}

}  // namespace grelha
