#include "frontend/scene/point_spacing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>

#include "frontend/scene/scene_builder.hpp"

namespace grelha {
namespace {

/// On a square lattice the third neighbour is one step away, at a corner as well; of points
/// scattered as densely, .92 of that.
constexpr std::size_t kNeighbor = 3;
constexpr double kShare = .65;  ///< of the spacing: half would touch on a square lattice
constexpr std::size_t kSamples = 1000;
constexpr std::size_t kMostLooks = 20000;  ///< to each side: enough for a slab of 10^8 points

using Point = std::array<float, 3>;

/// The axis along which half of the points lie furthest apart.
std::size_t longest_axis(std::vector<Point>& points) {
  std::size_t best = 0;
  float most = -1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto less = [axis](const Point& a, const Point& b) { return a[axis] < b[axis]; };
    const auto quarter = points.begin() + std::ptrdiff_t(points.size() / 4);
    const auto three = points.begin() + std::ptrdiff_t(3 * points.size() / 4);
    std::nth_element(points.begin(), quarter, points.end(), less);
    std::nth_element(quarter, three, points.end(), less);
    if ((*three)[axis] - (*quarter)[axis] > most) {
      most = (*three)[axis] - (*quarter)[axis];
      best = axis;
    }
  }
  return best;
}

double square_distance(const Point& a, const Point& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
    sum += (double{a[i]} - b[i]) * (double{a[i]} - b[i]);
  return sum;
}

/// The squares of the distances to the nearest points in other places.
class Nearest {
 public:
  explicit Nearest(std::size_t count) : squares_(count, HUGE_VAL) {}
  /// Returns false where no later point along the axis can be nearer.
  bool add(const Point& from, const Point& to, std::size_t axis) {
    const double along = double{to[axis]} - from[axis];
    if (along * along >= squares_.back())
      return false;
    const double square = square_distance(from, to);
    if (square > 0 && square < squares_.back()) {
      squares_.back() = square;
      std::ranges::sort(squares_);
    }
    return true;
  }
  /// The distance to the last of them, or to as many as there are; 0 of none.
  double distance() const {
    for (auto square = squares_.rbegin(); square != squares_.rend(); ++square)
      if (*square < HUGE_VAL)
        return std::sqrt(*square);
    return 0;
  }

 private:
  std::vector<double> squares_;  ///< in ascending order
};

/// Looks to both sides of a point among points sorted along an axis.
double distance_at(const std::vector<Point>& points, std::size_t i, std::size_t axis) {
  const bool few = points.size() <= 2 * kNeighbor;  // then the third may be the furthest
  Nearest nearest(few ? 1 : kNeighbor);
  for (std::size_t k = 1; k <= std::min(kMostLooks, points.size() - 1 - i); ++k)
    if (!nearest.add(points[i], points[i + k], axis))
      break;
  for (std::size_t k = 1; k <= std::min(kMostLooks, i); ++k)
    if (!nearest.add(points[i], points[i - k], axis))
      break;
  return nearest.distance();
}

}  // namespace

float radius_for(const std::vector<float>& x,
                 const std::vector<float>& y,
                 const std::vector<float>& z) {
  std::vector<Point> points;
  points.reserve(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    if (is_finite_float(Float3{x[i], y[i], z[i]}))
      points.push_back({x[i], y[i], z[i]});
  if (points.size() < 2)
    return 1;
  const std::size_t axis = longest_axis(points);
  std::ranges::sort(points, [axis](const Point& a, const Point& b) {
    return std::tie(a[axis], a) < std::tie(b[axis], b);
  });
  std::vector<double> distances;
  const std::size_t samples = std::min(kSamples, points.size());
  for (std::size_t k = 0; k < samples; ++k)
    if (const double d = distance_at(points, k * points.size() / samples, axis); d > 0)
      distances.push_back(d);
  if (distances.empty())
    return 1;
  const auto median = distances.begin() + std::ptrdiff_t(distances.size() / 2);
  std::ranges::nth_element(distances, median);
  return float(kShare * *median);
}

}  // namespace grelha
