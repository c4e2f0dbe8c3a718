#include "frontend/scene/mesh.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <span>
#include <tuple>
#include <vector>

#include "frontend/scene/double3.hpp"
#include "kernel/base/sine.hpp"

namespace grelha {
namespace {

/// Triangles at a vertex beyond which all are smoothed, for each would look at each other.
constexpr std::size_t kMostAround = 256;

struct Corner {
  Double3 face;      ///< the triangle's normal, unit
  Double3 weighted;  ///< by Max's weight of this corner
};

Double3 point(const Triangles& t, std::uint32_t v) {
  return {t.x[v], t.y[v], t.z[v]};
}
Corner corner_of(const Triangles& t, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const Double3 ab = sum(1, point(t, b), -1, point(t, a)),
                ac = sum(1, point(t, c), -1, point(t, a));
  const Double3 normal = cross(ab, ac);
  if (normal == Double3{})
    return {};
  return {sum(1 / length(normal), normal, 0, normal),
          sum(1 / (dot(ab, ab) * dot(ac, ac)), normal, 0, normal)};
}

double least_cosine(double most_deg) {
  if (most_deg >= 180)
    return -2;
  const double radian = 3.14159265358979323846 / 180;
  return most_deg <= 90 ? sine_cosine(most_deg * radian).cosine
                        : -sine_cosine((180 - most_deg) * radian).cosine;
}

class Smoother {
 public:
  Smoother(Triangles& triangles, std::uint32_t first, double most_deg)
      : t_(triangles), first_(first), least_(least_cosine(most_deg)) {
    for (auto* of : {&t_.nx, &t_.ny, &t_.nz})
      of->resize(t_.vertex_count());
  }

  void run() {
    join_places();
    sort_corners();
    for (std::size_t v = 0; v + 1 < begin_.size(); ++v)
      smooth_place({corners_.data() + begin_[v], begin_[v + 1] - begin_[v]});
  }

 private:
  std::uint32_t& vertex(std::uint32_t corner) {
    return (corner % 3 == 0 ? t_.a : corner % 3 == 1 ? t_.b : t_.c)[first_ + corner / 3];
  }

  /// Finds one vertex for all in its place: many programs write three for each triangle.
  void join_places() {
    std::vector<std::uint32_t> used;
    has_normal_.assign(t_.vertex_count(), true);
    for (std::uint32_t k = 0; k < 3 * (t_.size() - first_); ++k)
      if (const std::uint32_t v = vertex(k); has_normal_[v]) {
        has_normal_[v] = false;
        used.push_back(v);
      }
    const auto bits = [](float c) { return std::bit_cast<std::uint32_t>(c + 0.f); };  // no -0
    const auto at = [&](std::uint32_t v) {
      return std::tuple(bits(t_.x[v]), bits(t_.y[v]), bits(t_.z[v]));
    };
    std::ranges::sort(used, [&](std::uint32_t v, std::uint32_t w) {
      return at(v) < at(w) || (at(v) == at(w) && v < w);
    });
    place_.resize(t_.vertex_count());
    for (std::size_t i = 0; i < used.size(); ++i)
      place_[used[i]] = i > 0 && at(used[i]) == at(used[i - 1]) ? place_[used[i - 1]] : used[i];
  }

  /// Lists the corners at each place, in their order.
  void sort_corners() {
    const auto count = std::uint32_t(3 * (t_.size() - first_));
    begin_.assign(t_.vertex_count() + 1, 0);
    for (std::uint32_t k = 0; k < count; ++k)
      ++begin_[place_[vertex(k)] + 1];
    for (std::size_t v = 1; v < begin_.size(); ++v)
      begin_[v] += begin_[v - 1];
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    corners_.resize(count);
    for (std::uint32_t k = 0; k < count; ++k)
      corners_[next[place_[vertex(k)]]++] = k;
  }

  void smooth_place(std::span<const std::uint32_t> corners) {
    around_.clear();
    own_.clear();
    for (const std::uint32_t k : corners) {
      const std::uint32_t other = k - k % 3;
      const Corner corner =
          corner_of(t_, vertex(k), vertex(other + (k + 1) % 3), vertex(other + (k + 2) % 3));
      if (corner.face == Double3{})
        continue;  // no area: it says nothing, and is not seen
      around_.push_back(corner);
      own_.push_back(k);
    }
    copy_of_.clear();
    Float3 normal;
    for (std::size_t i = 0; i < own_.size(); ++i) {
      if (i == 0 || own_.size() <= kMostAround)
        normal = mean_around(i);
      std::uint32_t& v = vertex(own_[i]);
      v = with_normal(v, normal);
    }
  }

  Float3 mean_around(std::size_t i) const {
    Double3 all{};
    for (const Corner& other : around_)
      if (around_.size() > kMostAround || dot(around_[i].face, other.face) >= least_)
        all = sum(1, all, 1, other.weighted);
    const double size = length(all);
    return in_floats(size > 0 ? sum(1 / size, all, 0, all) : around_[i].face);
  }

  /// Vertex v, or one of its copies, which are the last vertices, whose normal is this.
  std::uint32_t with_normal(std::uint32_t v, const Float3& normal) {
    const auto has = [&](std::size_t at) {
      return Float3{t_.nx[at], t_.ny[at], t_.nz[at]} == normal;
    };
    if (!has_normal_[v])
      set(v, normal);
    has_normal_[v] = true;
    if (has(v))
      return v;
    std::size_t at = t_.vertex_count() - copy_of_.size();
    for (const std::uint32_t original : copy_of_) {
      if (original == v && has(at))
        return std::uint32_t(at);
      ++at;
    }
    for (auto* of : {&t_.x, &t_.y, &t_.z, &t_.nx, &t_.ny, &t_.nz, &t_.red, &t_.green, &t_.blue})
      if (!of->empty())
        of->push_back((*of)[v]);
    copy_of_.push_back(v);
    set(at, normal);
    return std::uint32_t(at);
  }

  void set(std::size_t v, const Float3& normal) {
    t_.nx[v] = normal.x;
    t_.ny[v] = normal.y;
    t_.nz[v] = normal.z;
  }

  Triangles& t_;
  const std::uint32_t first_;
  const double least_;
  std::vector<bool> has_normal_;      ///< [vertices before]
  std::vector<std::uint32_t> place_;  ///< [vertices before] the first in the same place
  std::vector<std::uint32_t> begin_, corners_;
  std::vector<Corner> around_;
  std::vector<std::uint32_t> own_, copy_of_;  ///< corners at a place; what its copies are of
};

}  // namespace

void smooth_normals(Triangles& triangles, std::uint32_t first, double most_deg) {
  Smoother(triangles, first, most_deg).run();
}

namespace {

/// On a square lattice the third neighbour is one step away, at a corner as well; of points
/// scattered as densely, .92 of that.
constexpr std::size_t kNeighbor = 3;
constexpr double kShareOfSpacing = .65;  ///< of the spacing: half would touch on a square lattice
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
  return float(kShareOfSpacing * *median);
}

}  // namespace grelha
