#include "frontend/scene/cutting_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace grelha {
namespace {

constexpr int kNear = 2;  ///< a crossing so few grid steps from an end becomes that end

}  // namespace

std::optional<std::uint32_t> CuttingSweep::next_point() {
  if (next_ < known_ && (fresh_.empty() || !swept_before(fresh_.begin()->first, points_[next_])))
    return std::uint32_t(next_++);
  if (fresh_.empty())
    return std::nullopt;
  return fresh_.extract(fresh_.begin()).mapped();
}

bool CuttingSweep::run() {
  while (const std::optional<std::uint32_t> point = next_point()) {
    if (is_over())
      return false;
    pass(*point);
  }
  cut_behind();
  return is_clean_;
}

/// The common case, without a search: one edge ends and one begins, and no other passes the point.
bool CuttingSweep::go_on() {
  if (!events_.goes_on(here_))
    return false;
  const SweepLine::Place place = places_[events_.first_ending(here_)], next = std::next(place);
  const bool is_lowest = place == line_.begin();
  const Point2& here = points_[here_];
  if ((!is_lowest && std::prev(place)->goes_through(here)) ||
      (next != line_.end() && next->goes_through(here)))
    return false;
  line_.exchange(place, events_.first_beginning(here_));
  places_[place->edge] = place;
  above_ = next;
  if (!is_lowest)
    check(std::prev(place), place);
  check(place, std::next(place));
  insert_beginning();
  return true;
}

/// Inserts the edges that begin here; checks may find that their neighbours begin here as well.
void CuttingSweep::insert_beginning() {
  for (std::size_t i = 0; i < beginning_.size(); ++i) {
    const std::uint32_t e = beginning_[i];
    const SweepLine::Place place = places_[e] = line_.insert(above_, e);
    if (place != line_.begin())
      check(std::prev(place), place);
    check(place, std::next(place));
  }
}

/// Cuts the edges that pass the point, so that they begin there.
void CuttingSweep::cut_passing() {
  const Point2& here = points_[here_];
  while (above_ != line_.end() && above_->goes_through(here))
    let_begin_here(above_);
  while (above_ != line_.begin() && std::prev(above_)->goes_through(here))
    let_begin_here(std::prev(above_));
}

/// Takes an edge off the line, and has it begin at the point where the sweep is.
SweepLine::Place CuttingSweep::let_begin_here(SweepLine::Place place) {
  is_clean_ = false;
  const std::uint32_t edge = place->edge;
  beginning_.push_back(edge);
  edges_.push_back(edge_between(edges_[edge].left, here_, edges_[edge]));
  edges_[edge].left = here_;
  const SweepLine::Place next = line_.erase(place);
  if (above_ == place)
    above_ = next;
  places_.push_back(next);
  return next;
}

void CuttingSweep::pass(std::uint32_t point) {
  here_ = point;
  beginning_.clear();
  if (go_on())
    return;
  for (std::uint32_t e = events_.first_beginning(point); e != SweepEvents::kNone;
       e = events_.next_beginning(e))
    beginning_.push_back(e);
  const std::uint32_t ending = events_.first_ending(point);
  if (ending == SweepEvents::kNone)
    above_ = line_.first_above(points_[point]);
  for (std::uint32_t e = ending; e != SweepEvents::kNone; e = events_.next_ending(e)) {
    above_ = line_.erase(places_[e]);
    if (beginning_.empty() && above_ != line_.begin())
      check(std::prev(above_), above_);
  }
  cut_passing();
  insert_beginning();
}

/// Checks two edges that have become neighbours on the line.
void CuttingSweep::check(SweepLine::Place below, SweepLine::Place above) {
  if (above == line_.end())
    return;
  while (!is_over() && passing_.empty() && cut_one(below, above)) {
  }
  if (passing_.empty())
    return;
  std::vector<SweepLine::Place> passing;
  passing.swap(passing_);
  SweepLine::Place next;
  for (const SweepLine::Place place : passing)
    next = let_begin_here(place);
  if (next != line_.begin())
    check(std::prev(next), next);
}

/// Cuts two edges where they meet besides a common end, or at the first such place. Returns whether
/// edges on the line have changed.
bool CuttingSweep::cut_one(SweepLine::Place a, SweepLine::Place b) {
  if (!SweepLine::do_meet(*a, *b))
    return false;
  const int side1 = a->side_of(b->left), side2 = a->side_of(b->right);
  const int side3 = b->side_of(a->left), side4 = b->side_of(a->right);
  if (side1 * side2 < 0 && side3 * side4 < 0)
    return cut_at_crossing(a, b);
  const auto cut_at = [this](SweepLine::Place place, int side, std::uint32_t point) {
    return side == 0 && place->has_on_the_way(points_[point]) && cut(place, point);
  };
  const OutlineEdge of_a = edges_[a->edge], of_b = edges_[b->edge];
  return cut_at(a, side1, of_b.left) || cut_at(a, side2, of_b.right) ||
         cut_at(b, side3, of_a.left) || cut_at(b, side4, of_a.right);
}

bool CuttingSweep::cut_at_crossing(SweepLine::Place a, SweepLine::Place b) {
  is_clean_ = false;
  const std::uint32_t point = crossing_of(a, b);
  const auto is_end_of = [&](std::uint32_t e) {
    return edges_[e].left == point || edges_[e].right == point;
  };
  const bool of_a = !is_end_of(a->edge) && cut(a, point);
  const bool of_b = !is_end_of(b->edge) && cut(b, point);
  return of_a || of_b;
}

/// Returns the rounded crossing of two edges: one of their ends, or a new point.
std::uint32_t CuttingSweep::crossing_of(SweepLine::Place a, SweepLine::Place b) {
  const auto& [ignored_a, a1, a2] = *a;
  const auto& [ignored_b, b1, b2] = *b;
  const double at_a1 = turn(b1, b2, a1), at_a2 = turn(b1, b2, a2);
  const double t = std::clamp(at_a1 / (at_a1 - at_a2), 0., 1.);
  Point2 p{a1.x + t * (a2.x - a1.x), a1.y + t * (a2.y - a1.y)};
  // within both, as the point itself is
  const auto [a_low, a_high] = std::minmax(a1.y, a2.y);
  const auto [b_low, b_high] = std::minmax(b1.y, b2.y);
  p.x = std::clamp(p.x, std::max(a1.x, b1.x), std::min(a2.x, b2.x));
  p.y = std::clamp(p.y, std::max(a_low, b_low), std::min(a_high, b_high));
  const Point2 coarse{std::round(p.x / step_) * step_, std::round(p.y / step_) * step_};
  // the crossing lies behind the sweep, which has to pass it
  const Point2& here = points_[here_];
  if (swept_before(here, coarse) && a->has_on_the_way(coarse) && b->has_on_the_way(coarse))
    p = coarse;
  else if (!swept_before(here, p) && here.x - p.x <= step_)
    p.x = std::nextafter(here.x, HUGE_VAL);
  const OutlineEdge &e = edges_[a->edge], &f = edges_[b->edge];
  for (const std::uint32_t end : {e.left, e.right, f.left, f.right}) {
    const Point2& q = points_[end];
    if (std::max(std::abs(p.x - q.x), std::abs(p.y - q.y)) <= kNear * step_)
      return end;
  }
  return point_at(p, {e.side, f.side});
}

/// Returns the point at a place, or adds a new one.
std::uint32_t CuttingSweep::point_at(const Point2& p, const std::array<std::uint32_t, 2>& sides) {
  const auto end = points_.begin() + std::ptrdiff_t(known_);
  const auto known = std::lower_bound(points_.begin(), end, p, swept_before);
  if (known != end && *known == p)
    return std::uint32_t(known - points_.begin());
  auto point = std::uint32_t(points_.size());
  if (swept_before(points_[here_], p))
    point = fresh_.try_emplace(p, point).first->second;
  if (point == points_.size()) {
    points_.push_back(p);
    crossings_.push_back({sides, p});
    events_.add_point();
  }
  return point;
}

/// Cuts an edge on the line at a point. The part left of the point stays on the line, under another
/// number. Returns false if the sweep has passed the point, or would go back on its way along the
/// edge: then the edge is cut after the sweep.
bool CuttingSweep::cut(SweepLine::Place place, std::uint32_t point) {
  is_clean_ = false;
  const std::uint32_t edge = place->edge;
  OutlineEdge before = edges_[edge];
  const bool is_on_the_way = place->has_on_the_way(points_[point]);
  if (point == here_ && is_on_the_way) {
    if (std::ranges::find(passing_, place) == passing_.end())
      passing_.push_back(place);
    return false;
  }
  if (!is_on_the_way || !swept_before(points_[here_], points_[point])) {
    behind_.push_back({edge, before.left, before.right, point});
    return false;
  }
  before.right = point;
  const auto number = std::uint32_t(edges_.size());
  edges_.push_back(before);
  edges_[edge].left = point;
  places_.push_back(place);
  line_.exchange(place, number);
  events_.add_ending(number, point);
  events_.add_beginning(edge, point);
  return true;
}

/// A part of an edge, which may lead backwards.
OutlineEdge CuttingSweep::edge_between(std::uint32_t from,
                                       std::uint32_t to,
                                       OutlineEdge edge) const {
  const bool is_forward = swept_before(points_[from], points_[to]);
  edge.left = is_forward ? from : to;
  edge.right = is_forward ? to : from;
  edge.winding = is_forward ? edge.winding : -edge.winding;
  return edge;
}

void CuttingSweep::cut_behind() {
  for (const Cut& cut : behind_) {
    const OutlineEdge edge = edges_[cut.edge];
    if (edge.left != cut.left || edge.right != cut.right)
      continue;  // found again by the next sweep if need be
    edges_[cut.edge] = edge_between(edge.left, cut.point, edge);
    edges_.push_back(edge_between(cut.point, edge.right, edge));
  }
}

}  // namespace grelha
