#include "frontend/scene/flat_triangles.hpp"

#include <algorithm>
#include <queue>
#include <unordered_map>
#include <utility>

namespace grelha {
namespace {

using Corners = std::array<std::uint32_t, 3>;

class Mender {
 public:
  Mender(std::span<const Point2> points, std::vector<Corners>& triangles)
      : points_(points), triangles_(triangles) {}

  void run() {
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      note_if_flat(t);
    if (flat_.empty())
      return;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      note_sides(t);
    while (!flat_.empty()) {
      const std::uint32_t longest = flat_.top().second;
      flat_.pop();
      mend(longest);
    }
  }

 private:
  static std::uint64_t side(std::uint32_t a, std::uint32_t b) { return std::uint64_t(a) << 32 | b; }

  double length(std::uint32_t a, std::uint32_t b) const {
    const double x = points_[b].x - points_[a].x, y = points_[b].y - points_[a].y;
    return x * x + y * y;
  }
  bool is_flat(const Corners& t) const {
    return exact_turn(points_[t[0]], points_[t[1]], points_[t[2]]) == 0;
  }
  /// The same triangle, its longest side from the last corner to the first.
  Corners turned(const Corners& t) const {
    Corners best = t;
    for (const Corners& other : {Corners{t[1], t[2], t[0]}, Corners{t[2], t[0], t[1]}})
      if (length(other[2], other[0]) > length(best[2], best[0]))
        best = other;
    return best;
  }
  /// A triangle with two corners at one place leaves no gap for rays.
  void note_if_flat(std::uint32_t t) {
    if (!is_flat(triangles_[t]))
      return;
    const auto [a, b, c] = turned(triangles_[t]);
    if (points_[a] != points_[b] && points_[b] != points_[c])
      flat_.push({length(c, a), t});
  }
  void note_sides(std::uint32_t t) {
    const auto& [a, b, c] = triangles_[t];
    at_side_[side(a, b)] = at_side_[side(b, c)] = at_side_[side(c, a)] = t;
  }
  void mend(std::uint32_t flat) {
    if (!is_flat(triangles_[flat]))
      return;  // it was the neighbour of a longer one
    const auto [a, b, c] = turned(triangles_[flat]);
    const auto found = at_side_.find(side(a, c));
    if (found == at_side_.end())
      return;  // the side is the polygon's own
    const std::uint32_t neighbour = found->second;
    const Corners& other = triangles_[neighbour];
    const std::uint32_t d = other[0] != a && other[0] != c   ? other[0]
                            : other[1] != a && other[1] != c ? other[1]
                                                             : other[2];
    at_side_.erase(side(a, c));
    at_side_.erase(side(c, a));
    triangles_[flat] = {a, b, d};
    triangles_[neighbour] = {b, c, d};
    for (const std::uint32_t t : {flat, neighbour}) {
      note_sides(t);
      note_if_flat(t);
    }
  }

  std::span<const Point2> points_;
  std::vector<Corners>& triangles_;
  std::unordered_map<std::uint64_t, std::uint32_t> at_side_;
  std::priority_queue<std::pair<double, std::uint32_t>> flat_;  ///< the longest first
};

}  // namespace

void mend_flat_triangles(std::span<const Point2> points, std::vector<Corners>& triangles) {
  Mender(points, triangles).run();
}

}  // namespace grelha
