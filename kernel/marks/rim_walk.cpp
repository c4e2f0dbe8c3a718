#include "kernel/marks/rim_walk.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace grelha {
namespace {

/// Triangles on a way: of more, nobody can tell (a choice).
constexpr int kMostCrossed = 64;

using Corners = std::array<Triple, 3>;

Corners corners_of(const TriangleSpans& t, std::size_t i) {
  return {vertex_of(t, t.a[i]), vertex_of(t, t.b[i]), vertex_of(t, t.c[i])};
}
bool same(const Triple& a, const Triple& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}
Triple scaled(double s, const Triple& a) {
  return {s * a.x, s * a.y, s * a.z};
}
double length(const Triple& a) {
  return std::sqrt(dot(a, a));
}

/// What is seen around the middle of an edge, as long as it would be there: x along the edge, y
/// across it.
class AroundEdge {
 public:
  AroundEdge(const Triple& from, const Triple& a, const Triple& b) : from_(from) {
    const Triple to = minus({.5 * (a.x + b.x), .5 * (a.y + b.y), .5 * (a.z + b.z)}, from);
    distance_ = length(to);
    ahead_ = scaled(1 / distance_, to);
    const Triple edge = minus(b, a);
    const Triple across = minus(edge, scaled(dot(edge, ahead_), ahead_));
    x_ = scaled(1 / length(across), across);
    y_ = cross(ahead_, x_);
  }
  struct Spot {
    double x, y;
    bool seen;  ///< it lies before the viewpoint
  };
  Spot operator()(const Triple& p) const {
    const Triple to = minus(p, from_);
    const double depth = dot(to, ahead_);
    const double scale = distance_ / depth;
    return {scale * dot(to, x_), scale * dot(to, y_), depth > 0};
  }
  Triple beside(const Triple& p, double y) const {
    return {p.x + y * y_.x, p.y + y * y_.y, p.z + y * y_.z};
  }

 private:
  Triple from_, ahead_, x_, y_;
  double distance_;
};

/// A corner of a triangle on the way, and where it is seen.
struct SeenCorner {
  std::size_t corner;
  AroundEdge::Spot at;
};

/// The edge between two corners.
std::size_t edge_between(std::size_t a, std::size_t b) {
  return (a + 1) % 3 == b ? a : b;
}

/// y where the way crosses the stretch between two spots.
double way_to(const AroundEdge::Spot& a, const AroundEdge::Spot& b) {
  return a.x != b.x ? a.y + a.x / (a.x - b.x) * (b.y - a.y) : a.y;
}

}  // namespace

Rod RimWalk::edge(std::size_t i, std::size_t k) const {
  const Corners c = corners_of(t_, i);
  const Triple& a = c[k];
  const Triple& b = c[(k + 1) % 3];
  return {{{a.x, a.y, a.z}, {b.x, b.y, b.z}}, 0, 0, 0};
}

bool RimWalk::may_be_thin(std::size_t i, std::size_t k, double enough) const {
  const Corners c = corners_of(t_, i);
  const AroundEdge view(from_, c[k], c[(k + 1) % 3]);
  const AroundEdge::Spot third = view(c[(k + 2) % 3]);
  const double y = way_to(view(c[third.x > 0 ? k : (k + 1) % 3]), third);
  return !third.seen || !(std::abs(y) >= enough);
}

Rod RimWalk::strip(std::size_t i, std::size_t k, double enough) const {
  Corners c = corners_of(t_, i);
  const Triple a = c[k];
  const Triple b = c[(k + 1) % 3];
  const Triple normal = cross(minus(b, a), minus(c[(k + 2) % 3], a));
  const double height = length(normal) / length(minus(b, a));
  double whole = 0;
  for (std::size_t j = 0; j < 3; ++j)
    whole = std::max(whole, length(minus(c[(j + 1) % 3], c[j])));
  const AroundEdge view(from_, a, b);
  SeenCorner left{k, view(a)};
  SeenCorner right{(k + 1) % 3, view(b)};
  double y = 0;
  for (int crossed = 0; crossed < kMostCrossed; ++crossed) {
    const std::size_t third = 3 - left.corner - right.corner;
    const SeenCorner next{third, view(c[third])};
    if (!next.at.seen)
      break;
    (next.at.x > 0 ? right : left) = next;
    y = way_to(left.at, right.at);
    const std::size_t out = edge_between(left.corner, right.corner);
    if (std::abs(y) >= enough || (rims_.rims(i, v_) >> out & 1))
      break;
    const Triple on_left = c[left.corner];
    const Triple on_right = c[right.corner];
    i = rims_.across(i, out);
    c = corners_of(t_, i);
    for (std::size_t j = 0; j < 3; ++j) {
      if (same(c[j], on_left))
        left.corner = j;
      if (same(c[j], on_right))
        right.corner = j;
    }
  }
  const Triple from = view.beside(a, y / 2);
  const Triple to = view.beside(b, y / 2);
  const double width = std::abs(y);
  return {{{from.x, from.y, from.z}, {to.x, to.y, to.z}},
          width,
          std::max(width, height),
          width / 2,
          whole};
}

}  // namespace grelha
