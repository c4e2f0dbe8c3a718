#include "frontend/scene/sweep_line.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "kernel/base/exact_numbers.hpp"

namespace grelha {

int exactly_summed_turn(const Point2& a, const Point2& b, const Point2& c) {
  if (a == b || b == c || c == a)
    return 0;
  Expansion sum;
  sum.add_product(b.x, c.y);
  sum.add_product(-b.x, a.y);
  sum.add_product(-a.x, c.y);
  sum.add_product(-b.y, c.x);
  sum.add_product(b.y, a.x);
  sum.add_product(a.y, c.x);
  return sum.sign();
}

namespace {

constexpr std::uint32_t kNone = SweepEvents::kNone;

/// The boundary of the triangulated area, between two neighbours on the line with the inside
/// between them: points from the lower edge's left end to the upper one's. Inner corners are reflex
/// or flat.
struct Front {
  std::uint32_t low, high, foremost;  ///< nodes
};

class FillingSweep {
 public:
  FillingSweep(const std::vector<Point2>& points, const std::vector<OutlineEdge>& edges)
      : points_(points),
        edges_(edges),
        events_(points.size(), edges),
        line_(points, edges),
        iterators_(edges.size()),
        above_(edges.size()) {}

  std::optional<EvenOddFill> run() {
    for (std::uint32_t point = 0; point < points_.size(); ++point) {
      process_event(point);
      if (!is_arranged_)
        return std::nullopt;
    }
    return std::move(fill_);
  }

 private:
  struct Node {
    std::uint32_t point, down, up;
  };
  /// The region above an edge on the line.
  struct Gap {
    std::uint32_t front = kNone;  ///< where it is inside
    std::int32_t winding = 0;
  };
  struct Fronts {
    std::uint32_t below = kNone, above = kNone;
  };

  bool continue_edge(std::uint32_t point);
  void process_event(std::uint32_t point);
  Fronts end_edges(std::uint32_t point, SweepLine::Iterator& above);
  void begin_edges(std::uint32_t point,
                   SweepLine::Iterator above,
                   const Gap& below,
                   const Fronts& fronts);
  std::uint32_t begin_front(std::uint32_t point);
  Fronts split(std::uint32_t front, std::uint32_t point);
  std::uint32_t join(std::uint32_t below, std::uint32_t above);
  void add(Front& front, std::uint32_t point, bool is_above);
  void add_below(Front& front, std::uint32_t point) { add(front, point, false); }
  void add_above(Front& front, std::uint32_t point) { add(front, point, true); }
  void close_front(std::uint32_t front, std::uint32_t point);

  void check_winding(std::int32_t winding, bool is_inside) {
    fill_.is_crossed = fill_.is_crossed || winding != (is_inside ? 1 : 0);
  }
  /// Checks an edge and its new neighbour below.
  void check_below(SweepLine::Iterator at) {
    if (at != line_.begin() && at != line_.end())
      is_arranged_ = is_arranged_ && !SweepLine::intersect_edges(*std::prev(at), *at);
  }
  Gap& gap_above(SweepLine::Iterator at) { return above_[at->edge]; }
  std::uint32_t add_node(std::uint32_t point, std::uint32_t down, std::uint32_t up) {
    nodes_.push_back({point, down, up});
    return std::uint32_t(nodes_.size() - 1);
  }
  int turn_of(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return exact_turn(points_[a], points_[b], points_[c]);
  }
  void emit(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    fill_.triangles.push_back({a, b, c});
  }

  const std::vector<Point2>& points_;
  const std::vector<OutlineEdge>& edges_;
  SweepEvents events_;
  SweepLine line_;
  std::vector<SweepLine::Iterator> iterators_;  ///< [edges] positions of edges on the line
  std::vector<Gap> above_;                      ///< [edges]
  std::vector<Node> nodes_;
  std::vector<Front> fronts_;
  std::vector<std::uint32_t> closing_;
  EvenOddFill fill_;
  bool is_arranged_ = true;
};

/// One edge ends and one begins, at the same position.
bool FillingSweep::continue_edge(std::uint32_t point) {
  if (!events_.goes_on(point))
    return false;
  const SweepLine::Iterator at = iterators_[events_.first_ending(point)];
  const bool is_lowest = at == line_.begin();
  const Gap below = is_lowest ? Gap{} : gap_above(std::prev(at));
  const std::uint32_t above = gap_above(at).front;
  if (below.front != kNone)
    add_above(fronts_[below.front], point);
  if (above != kNone)
    add_below(fronts_[above], point);
  const std::uint32_t edge = events_.first_start(point);
  line_.replace_edge(at, edge);
  iterators_[edge] = at;
  check_below(at);
  check_below(std::next(at));
  check_winding(below.winding + edges_[edge].winding, above != kNone);
  above_[edge] = {above, below.winding + edges_[edge].winding};
  return true;
}

void FillingSweep::process_event(std::uint32_t point) {
  if (continue_edge(point))
    return;
  if (events_.first_ending(point) == kNone && events_.first_start(point) == kNone)
    return;  // all its edges lay on others
  SweepLine::Iterator above = line_.end();
  Fronts fronts = end_edges(point, above);
  const bool is_lowest = above == line_.begin();
  Gap* const below = is_lowest ? nullptr : &gap_above(std::prev(above));
  if (events_.first_start(point) != kNone) {
    const Gap before = below ? *below : Gap{};
    if (below)
      below->front = fronts.below;
    begin_edges(point, above, before, fronts);
  } else {
    check_below(above);
    if (below && fronts.below != kNone && fronts.above != kNone)
      below->front = join(fronts.below, fronts.above);
  }
}

/// Takes the edges that end at the point off the line. Returns the fronts of the inside below and
/// above it, which have the point, and the position above it.
FillingSweep::Fronts FillingSweep::end_edges(std::uint32_t point, SweepLine::Iterator& above) {
  const std::uint32_t any = events_.first_ending(point);
  if (any == kNone) {
    above = line_.first_above(points_[point]);
    const std::uint32_t front = above == line_.begin() ? kNone : gap_above(std::prev(above)).front;
    return front == kNone ? Fronts{} : split(front, point);
  }
  SweepLine::Iterator lowest = iterators_[any];
  while (lowest != line_.begin() && edges_[std::prev(lowest)->edge].right == point)
    --lowest;
  Fronts fronts;
  if (lowest != line_.begin())
    fronts.below = gap_above(std::prev(lowest)).front;
  for (above = lowest;;) {
    const std::uint32_t front = gap_above(above).front;
    above = line_.erase(above);
    if (above == line_.end() || edges_[above->edge].right != point) {
      fronts.above = front;
      break;
    }
    if (front != kNone)
      close_front(front, point);
  }
  if (fronts.below != kNone)
    add_above(fronts_[fronts.below], point);
  if (fronts.above != kNone)
    add_below(fronts_[fronts.above], point);
  return fronts;
}

/// Puts the edges that begin at the point on the line, each with the region above it.
void FillingSweep::begin_edges(std::uint32_t point,
                               SweepLine::Iterator above,
                               const Gap& below,
                               const Fronts& fronts) {
  std::uint32_t count = 0;
  SweepLine::Iterator lowest = line_.end();
  for (std::uint32_t e = events_.first_start(point); e != kNone; e = events_.next_start(e)) {
    iterators_[e] = line_.insert(above, e);
    lowest = iterators_[e];
    ++count;
  }
  while (lowest != line_.begin() && edges_[std::prev(lowest)->edge].left == point)
    --lowest;
  std::int32_t winding = below.winding;
  bool is_inside = fronts.below != kNone;
  SweepLine::Iterator at = lowest;
  for (; count-- > 0; ++at) {
    if (at == line_.end() || edges_[at->edge].left != point) {
      is_arranged_ = false;  // another edge passes the point
      return;
    }
    check_below(at);
    winding += edges_[at->edge].winding;
    is_inside = !is_inside;
    check_winding(winding, is_inside);
    const std::uint32_t inner = is_inside && count > 0 ? begin_front(point) : kNone;
    gap_above(at) = {count == 0 ? fronts.above : inner, winding};
  }
  check_below(at);
}

std::uint32_t FillingSweep::begin_front(std::uint32_t point) {
  const std::uint32_t node = add_node(point, kNone, kNone);
  fronts_.push_back({node, node, node});
  return std::uint32_t(fronts_.size() - 1);
}

/// Splits a front at a point inside: its foremost point sees the new one, and belongs to both
/// parts.
FillingSweep::Fronts FillingSweep::split(std::uint32_t front, std::uint32_t point) {
  Front& lower = fronts_[front];
  const std::uint32_t middle = lower.foremost, up = nodes_[middle].up;
  const std::uint32_t twin = add_node(nodes_[middle].point, kNone, up);
  Front upper{twin, lower.high, twin};
  if (up != kNone)
    nodes_[up].down = twin;
  else
    upper.high = twin;
  nodes_[middle].up = kNone;
  lower.high = middle;
  add_above(lower, point);
  add_below(upper, point);
  fronts_.push_back(upper);
  return {front, std::uint32_t(fronts_.size() - 1)};
}

/// Joins two fronts that end and begin with the same point.
std::uint32_t FillingSweep::join(std::uint32_t below, std::uint32_t above) {
  Front &lower = fronts_[below], &upper = fronts_[above];
  const std::uint32_t next = nodes_[upper.low].up;
  nodes_[lower.high].up = next;
  if (next != kNone) {
    nodes_[next].down = lower.high;
    lower.foremost = lower.high;
    lower.high = upper.high;
  }
  return below;
}

/// Adds the right end of the inside's upper edge, or of its lower one: cuts off the triangles that
/// this point sees, from that end of the front on. The nearest of several corners in line with the
/// point hides the others.
void FillingSweep::add(Front& front, std::uint32_t point, bool is_above) {
  std::uint32_t& end = is_above ? front.high : front.low;
  const auto inward = [&](std::uint32_t node) {
    return is_above ? nodes_[node].down : nodes_[node].up;
  };
  const auto turn = [&](std::uint32_t a, std::uint32_t b) {
    const int left = turn_of(nodes_[a].point, point, nodes_[b].point);
    return is_above ? left : -left;
  };
  const auto cut_off = [&](std::uint32_t a, std::uint32_t b, std::uint32_t apex) {
    is_above ? emit(a, b, apex) : emit(apex, b, a);
  };
  std::uint32_t last = end;
  for (std::uint32_t next = inward(last); next != kNone; next = inward(last)) {
    if (turn(next, last) <= 0)
      break;
    const std::uint32_t apex = nodes_[last].point;
    for (std::uint32_t nearer = inward(next);
         nearer != kNone && turn(nearer, next) == 0 &&
         swept_before(points_[nodes_[next].point], points_[nodes_[nearer].point]);
         nearer = inward(next)) {
      cut_off(nodes_[next].point, nodes_[nearer].point, apex);
      next = nearer;
    }
    cut_off(nodes_[next].point, point, apex);
    last = next;
  }
  end = front.foremost = is_above ? add_node(point, last, kNone) : add_node(point, kNone, last);
  (is_above ? nodes_[last].up : nodes_[last].down) = end;
}

/// Both edges end at the point, which sees all of the front. Corners in line with it stand on one
/// of the edges that end: they are cut off from the corner beside them.
void FillingSweep::close_front(std::uint32_t front, std::uint32_t point) {
  closing_.clear();
  for (std::uint32_t node = fronts_[front].low; node != kNone; node = nodes_[node].up)
    closing_.push_back(nodes_[node].point);
  std::size_t first = 0, last = closing_.size() - 1;
  while (first < last && turn_of(closing_[first], point, closing_[first + 1]) == 0)
    ++first;
  while (first < last && turn_of(closing_[last - 1], point, closing_[last]) == 0)
    --last;
  if (first == last)
    return;
  // `first` and `last` end the lines that go on to the point past those before and behind them
  for (std::size_t i = first; i > 0; --i)
    emit(closing_[i], closing_[i - 1], closing_[first + 1]);
  std::uint32_t low = closing_[0];
  for (std::size_t i = first + 1; i < last; ++i) {
    emit(low, point, closing_[i]);
    low = closing_[i];
  }
  for (std::size_t i = last; i + 1 < closing_.size(); ++i)
    emit(low, closing_[i + 1], closing_[i]);
  emit(low, point, closing_.back());
}

}  // namespace

std::optional<EvenOddFill> fill_even_odd(const std::vector<Point2>& points,
                                         const std::vector<OutlineEdge>& edges) {
  return FillingSweep(points, edges).run();
}

}  // namespace grelha
