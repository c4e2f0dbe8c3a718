#include "frontend/scene/outline.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "frontend/scene/cutting_sweep.hpp"

namespace grelha {
namespace {

/// Crossings are rounded to a grid of so many bits of the outline's size, far below the last place
/// of a float. Crossings of sides with a common point become one point.
constexpr int kGridBits = 46;
/// Three or four sweeps are enough, except for some outlines of hundreds of sides on a lattice.
/// Further sweeps each double the grid step, because some sides cross again as soon as they are
/// rounded.
constexpr int kFineSweeps = 4, kMostSweeps = 24;

/// Shears a point to the side. Returns true if no bit was lost.
bool shear_point(Point2& p) {
  constexpr double kShare = 0x61C88p-20;  // a golden section: few drawings have such a slope
  const double off = kShare * p.y, x = p.x + off;
  const double shared = x - p.x, lost = (p.x - (x - shared)) + (off - shared);
  p.x = x;
  return lost == 0 && std::fma(kShare, p.y, -off) == 0;
}

}  // namespace

/// Shears the plane: the sweep would meet sides along its line, or nearly so, all at once, in an
/// order that depends on rounding. Shearing preserves left turns. Keeps the corners if shearing
/// would lose a bit.
Outline::Outline(std::span<const Point2> corner_points)
    : corner_points_(corner_points.begin(), corner_points.end()) {
  if (!std::ranges::all_of(corner_points_, shear_point, [](Point2& p) -> Point2& { return p; }))
    corner_points_.assign(corner_points.begin(), corner_points.end());
  points_ = corner_points_;
  numbers_.resize(points_.size());
  std::iota(numbers_.begin(), numbers_.end(), 0);
  edges_.reserve(points_.size());
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    const std::uint32_t next = i + 1 == points_.size() ? 0 : i + 1;
    if (swept_before(points_[i], points_[next]))
      edges_.push_back({i, next, i, 1});
    else
      edges_.push_back({next, i, i, -1});
  }
}

double Outline::share_of(std::uint32_t side, const Point2& point) const {
  const Point2 &a = corner_points_[side], &b = corner_points_[(side + 1) % corner_points_.size()];
  const double x = b.x - a.x, y = b.y - a.y;
  return std::clamp(((point.x - a.x) * x + (point.y - a.y) * y) / (x * x + y * y), 0., 1.);
}

/// Sorts the points and the edges, and merges points at one position. Returns true if there were
/// any.
bool Outline::simplify() {
  struct NumberedPoint {
    Point2 p;
    std::uint32_t number, before;
  };
  std::vector<NumberedPoint> sorted(points_.size());
  for (std::uint32_t i = 0; i < points_.size(); ++i)
    sorted[i] = {points_[i], numbers_[i], i};
  std::ranges::sort(sorted, [](const NumberedPoint& a, const NumberedPoint& b) {
    return std::tie(a.p.x, a.p.y, a.number) < std::tie(b.p.x, b.p.y, b.number);
  });
  std::vector<std::uint32_t> now(sorted.size());
  points_.clear();
  numbers_.clear();
  for (const NumberedPoint& point : sorted) {
    if (points_.empty() || points_.back() != point.p) {
      points_.push_back(point.p);
      numbers_.push_back(point.number);
    }
    now[point.before] = std::uint32_t(points_.size() - 1);
  }
  for (OutlineEdge& edge : edges_) {
    edge.left = now[edge.left];
    edge.right = now[edge.right];
  }
  std::erase_if(edges_, [](const OutlineEdge& e) { return e.left == e.right; });
  std::ranges::sort(
      edges_, {}, [](const OutlineEdge& e) { return std::tuple(e.left, e.right, e.side); });
  return points_.size() < sorted.size();
}

void Outline::merge_equal_edges() {
  std::size_t count = 0;
  for (std::size_t i = 0, next; i < edges_.size(); i = next) {
    OutlineEdge edge = edges_[i];
    for (next = i + 1;
         next < edges_.size() && edges_[next].left == edge.left && edges_[next].right == edge.right;
         ++next)
      edge.winding += edges_[next].winding;
    is_doubled_ = is_doubled_ || std::abs(edge.winding) > 1;
    if ((next - i) % 2 == 1)
      edges_[count++] = edge;
  }
  edges_.resize(count);
}

double Outline::grid_step() const {
  double low = points_[0].y, high = low;
  for (const Point2& p : points_) {
    low = std::min(low, p.y);
    high = std::max(high, p.y);
  }
  const double width = points_.back().x - points_.front().x;
  int power = 0;
  std::frexp(std::max(width, high - low), &power);
  return std::ldexp(1., power - kGridBits);
}

bool Outline::try_fill() {
  std::optional<EvenOddFill> fill = fill_even_odd(points_, edges_);
  if (!fill)
    return false;
  fill_ = std::move(*fill);
  for (auto& triangle : fill_.triangles)
    for (std::uint32_t& corner : triangle)
      corner = numbers_[corner];
  fill_.is_crossed = fill_.is_crossed || is_doubled_;
  return true;
}

Outline::State Outline::arrange() {
  bool is_changed = simplify();
  double step = grid_step();
  std::size_t swept = 0;
  const std::size_t most = 4 * (kMostCuts + corner_points_.size());
  for (int sweep = 0; sweep < kMostSweeps && swept <= most; ++sweep) {
    merge_equal_edges();
    if (try_fill())
      return is_changed ? State::kWasCut : State::kSimple;
    is_changed = true;
    CuttingSweep cutting(points_, intersections_, edges_, step, kMostCuts);
    cutting.run();
    if (cutting.is_over())
      return State::kCutLimit;
    while (numbers_.size() < points_.size()) {
      const std::size_t behind = points_.size() - numbers_.size();
      numbers_.push_back(std::uint32_t(corner_points_.size() + intersections_.size() - behind));
    }
    simplify();
    swept += edges_.size();
    if (sweep + 1 >= kFineSweeps)
      step *= 2;
  }
  return State::kCutLimit;
}

}  // namespace grelha
