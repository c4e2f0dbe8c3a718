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

void CuttingSweep::run() {
  while (const std::optional<std::uint32_t> point = next_point()) {
    if (is_over())
      return;
    pass(*point);
  }
  cut_passed();
}

/// The common case, without a search: one edge ends and one begins, and no other passes the point.
bool CuttingSweep::go_on() {
  if (!events_.goes_on(event_point_))
    return false;
  const SweepLine::Iterator at = iterators_[events_.first_ending(event_point_)],
                            next = std::next(at);
  const bool is_lowest = at == line_.begin();
  const Point2& here = points_[event_point_];
  if ((!is_lowest && std::prev(at)->contains_point(here)) ||
      (next != line_.end() && next->contains_point(here)))
    return false;
  line_.replace_edge(at, events_.first_start(event_point_));
  iterators_[at->edge] = at;
  above_ = next;
  if (!is_lowest)
    check(std::prev(at), at);
  check(at, std::next(at));
  insert_starting();
  return true;
}

/// Inserts the edges that begin here; checks may find that their neighbours begin here as well.
void CuttingSweep::insert_starting() {
  for (std::size_t i = 0; i < starting_.size(); ++i) {
    const std::uint32_t e = starting_[i];
    const SweepLine::Iterator at = iterators_[e] = line_.insert(above_, e);
    if (at != line_.begin())
      check(std::prev(at), at);
    check(at, std::next(at));
  }
}

/// Cuts the edges that pass the point, so that they begin there.
void CuttingSweep::cut_crossing() {
  const Point2& here = points_[event_point_];
  while (above_ != line_.end() && above_->contains_point(here))
    insert_starting_edges(above_);
  while (above_ != line_.begin() && std::prev(above_)->contains_point(here))
    insert_starting_edges(std::prev(above_));
}

/// Takes an edge off the line, and has it begin at the point where the sweep is.
SweepLine::Iterator CuttingSweep::insert_starting_edges(SweepLine::Iterator at) {
  const std::uint32_t edge = at->edge;
  starting_.push_back(edge);
  edges_.push_back(edge_between(edges_[edge].left, event_point_, edges_[edge]));
  edges_[edge].left = event_point_;
  const SweepLine::Iterator next = line_.erase(at);
  if (above_ == at)
    above_ = next;
  iterators_.push_back(next);
  return next;
}

void CuttingSweep::pass(std::uint32_t point) {
  event_point_ = point;
  starting_.clear();
  if (go_on())
    return;
  for (std::uint32_t e = events_.first_start(point); e != SweepEvents::kNone;
       e = events_.next_start(e))
    starting_.push_back(e);
  const std::uint32_t ending = events_.first_ending(point);
  if (ending == SweepEvents::kNone)
    above_ = line_.first_above(points_[point]);
  for (std::uint32_t e = ending; e != SweepEvents::kNone; e = events_.next_ending(e)) {
    above_ = line_.erase(iterators_[e]);
    if (starting_.empty() && above_ != line_.begin())
      check(std::prev(above_), above_);
  }
  cut_crossing();
  insert_starting();
}

/// Checks two edges that have become neighbours on the line.
void CuttingSweep::check(SweepLine::Iterator below, SweepLine::Iterator above) {
  if (above == line_.end())
    return;
  while (!is_over() && crossing_.empty() && cut_one(below, above)) {
  }
  if (crossing_.empty())
    return;
  std::vector<SweepLine::Iterator> passing;
  passing.swap(crossing_);
  SweepLine::Iterator next;
  for (const SweepLine::Iterator at : passing)
    next = insert_starting_edges(at);
  if (next != line_.begin())
    check(std::prev(next), next);
}

/// Cuts two edges where they intersect besides a common end, or at the first such point. Returns
/// whether edges on the line have changed.
bool CuttingSweep::cut_one(SweepLine::Iterator a, SweepLine::Iterator b) {
  if (!SweepLine::intersect_edges(*a, *b))
    return false;
  const int side1 = a->side_of(b->left), side2 = a->side_of(b->right);
  const int side3 = b->side_of(a->left), side4 = b->side_of(a->right);
  if (side1 * side2 < 0 && side3 * side4 < 0)
    return cut_at_crossing(a, b);
  const auto cut_at = [this](SweepLine::Iterator at, int side, std::uint32_t point) {
    return side == 0 && at->spans_point(points_[point]) && cut(at, point);
  };
  const OutlineEdge of_a = edges_[a->edge], of_b = edges_[b->edge];
  return cut_at(a, side1, of_b.left) || cut_at(a, side2, of_b.right) ||
         cut_at(b, side3, of_a.left) || cut_at(b, side4, of_a.right);
}

bool CuttingSweep::cut_at_crossing(SweepLine::Iterator a, SweepLine::Iterator b) {
  const std::uint32_t point = crossing_of(a, b);
  const auto is_end_of = [&](std::uint32_t e) {
    return edges_[e].left == point || edges_[e].right == point;
  };
  const bool of_a = !is_end_of(a->edge) && cut(a, point);
  const bool of_b = !is_end_of(b->edge) && cut(b, point);
  return of_a || of_b;
}

/// Returns the rounded crossing of two edges: one of their ends, or a new point.
std::uint32_t CuttingSweep::crossing_of(SweepLine::Iterator a, SweepLine::Iterator b) {
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
  const Point2& here = points_[event_point_];
  if (swept_before(here, coarse) && a->spans_point(coarse) && b->spans_point(coarse))
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

/// Returns the point at a position, or adds a new one.
std::uint32_t CuttingSweep::point_at(const Point2& p, const std::array<std::uint32_t, 2>& sides) {
  const auto end = points_.begin() + std::ptrdiff_t(known_);
  const auto known = std::lower_bound(points_.begin(), end, p, swept_before);
  if (known != end && *known == p)
    return std::uint32_t(known - points_.begin());
  auto point = std::uint32_t(points_.size());
  if (swept_before(points_[event_point_], p))
    point = fresh_.try_emplace(p, point).first->second;
  if (point == points_.size()) {
    points_.push_back(p);
    intersections_.push_back({sides, p});
    events_.add_point();
  }
  return point;
}

/// Cuts an edge on the line at a point. The part left of the point stays on the line, under another
/// number. Returns false if the sweep has passed the point, or would go back on its way along the
/// edge: then the edge is cut after the sweep.
bool CuttingSweep::cut(SweepLine::Iterator at, std::uint32_t point) {
  const std::uint32_t edge = at->edge;
  OutlineEdge before = edges_[edge];
  const bool is_on_the_way = at->spans_point(points_[point]);
  if (point == event_point_ && is_on_the_way) {
    if (std::ranges::find(crossing_, at) == crossing_.end())
      crossing_.push_back(at);
    return false;
  }
  if (!is_on_the_way || !swept_before(points_[event_point_], points_[point])) {
    passed_.push_back({edge, before.left, before.right, point});
    return false;
  }
  before.right = point;
  const auto number = std::uint32_t(edges_.size());
  edges_.push_back(before);
  edges_[edge].left = point;
  iterators_.push_back(at);
  line_.replace_edge(at, number);
  events_.add_ending(number, point);
  events_.add_start(edge, point);
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

void CuttingSweep::cut_passed() {
  for (const Cut& cut : passed_) {
    const OutlineEdge edge = edges_[cut.edge];
    if (edge.left != cut.left || edge.right != cut.right)
      continue;  // found again by the next sweep if need be
    edges_[cut.edge] = edge_between(edge.left, cut.point, edge);
    edges_.push_back(edge_between(cut.point, edge.right, edge));
  }
}

}  // namespace grelha
