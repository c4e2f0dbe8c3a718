#include "frontend/scene/flat_triangles.hpp"

#include <algorithm>
#include <queue>
#include <unordered_map>
#include <utility>

namespace grelha {
namespace {

using Vertices = std::array<std::uint32_t, 3>;

class Fixer {
 public:
  Fixer(std::span<const Point2> points, std::vector<Vertices>& triangles)
      : points_(points), triangles_(triangles) {}

  void run() {
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      record_flat(t);
    if (flat_.empty())
      return;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      record_sides(t);
    while (!flat_.empty()) {
      const std::uint32_t longest = flat_.top().second;
      flat_.pop();
      fix(longest);
    }
  }

 private:
  static std::uint64_t side(std::uint32_t a, std::uint32_t b) { return std::uint64_t(a) << 32 | b; }

  double length(std::uint32_t a, std::uint32_t b) const {
    const double x = points_[b].x - points_[a].x, y = points_[b].y - points_[a].y;
    return x * x + y * y;
  }
  bool is_flat(const Vertices& t) const {
    return exact_turn(points_[t[0]], points_[t[1]], points_[t[2]]) == 0;
  }
  /// The same triangle, its longest side from the last corner to the first.
  Vertices turned(const Vertices& t) const {
    Vertices best = t;
    for (const Vertices& other : {Vertices{t[1], t[2], t[0]}, Vertices{t[2], t[0], t[1]}})
      if (length(other[2], other[0]) > length(best[2], best[0]))
        best = other;
    return best;
  }
  /// A triangle with two corners at one position leaves no gap for rays.
  void record_flat(std::uint32_t t) {
    if (!is_flat(triangles_[t]))
      return;
    const auto [a, b, c] = turned(triangles_[t]);
    if (points_[a] != points_[b] && points_[b] != points_[c])
      flat_.push({length(c, a), t});
  }
  void record_sides(std::uint32_t t) {
    const auto& [a, b, c] = triangles_[t];
    at_side_[side(a, b)] = at_side_[side(b, c)] = at_side_[side(c, a)] = t;
  }
  void fix(std::uint32_t flat) {
    if (!is_flat(triangles_[flat]))
      return;  // it was the neighbour of a longer one
    const auto [a, b, c] = turned(triangles_[flat]);
    const auto found = at_side_.find(side(a, c));
    if (found == at_side_.end())
      return;  // the side is the polygon's own
    const std::uint32_t neighbour = found->second;
    const Vertices& other = triangles_[neighbour];
    const std::uint32_t d = other[0] != a && other[0] != c   ? other[0]
                            : other[1] != a && other[1] != c ? other[1]
                                                             : other[2];
    at_side_.erase(side(a, c));
    at_side_.erase(side(c, a));
    triangles_[flat] = {a, b, d};
    triangles_[neighbour] = {b, c, d};
    for (const std::uint32_t t : {flat, neighbour}) {
      record_sides(t);
      record_flat(t);
    }
  }

  std::span<const Point2> points_;
  std::vector<Vertices>& triangles_;
  std::unordered_map<std::uint64_t, std::uint32_t> at_side_;
  std::priority_queue<std::pair<double, std::uint32_t>> flat_;  ///< the longest first
};

}  // namespace

void fix_flat_triangles(std::span<const Point2> points, std::vector<Vertices>& triangles) {
  Fixer(points, triangles).run();
}

}  // namespace grelha
