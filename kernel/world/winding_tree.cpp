#include "kernel/world/winding_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "kernel/grid/grid.hpp"
#include "kernel/grid/packed_order.hpp"
#include "kernel/world/visible.hpp"
#include "kernel/shapes/triangle.hpp"

namespace grelha {
namespace {

constexpr double kRoundedUp = 1 + 0x1p-40;  ///< times a length or an area: no less than it truly is
constexpr double kLost = 0x1p-40;           ///< more than rounding takes from sums, of their terms
constexpr int kSecond[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
constexpr int kThird[10][3] = {{0, 0, 0},
                               {1, 1, 1},
                               {2, 2, 2},
                               {0, 0, 1},
                               {0, 0, 2},
                               {0, 1, 1},
                               {1, 1, 2},
                               {0, 2, 2},
                               {1, 2, 2},
                               {0, 1, 2}};
constexpr int kFourth[15][4] = {{0, 0, 0, 0},
                                {1, 1, 1, 1},
                                {2, 2, 2, 2},
                                {0, 0, 0, 1},
                                {0, 0, 0, 2},
                                {0, 1, 1, 1},
                                {1, 1, 1, 2},
                                {0, 2, 2, 2},
                                {1, 2, 2, 2},
                                {0, 0, 1, 1},
                                {0, 0, 2, 2},
                                {1, 1, 2, 2},
                                {0, 0, 1, 2},
                                {0, 1, 1, 2},
                                {0, 1, 2, 2}};
/// Of equal components of fourth.
constexpr double kFourthTimes[15] = {1, 1, 1, 4, 4, 4, 4, 4, 4, 6, 6, 6, 12, 12, 12};
/// Where a component of third or fourth stands, by its axes in any order, each two bits.
template <std::size_t kCount, int kRank>
constexpr auto places_of(const int (&all)[kCount][kRank]) {
  std::array<std::uint8_t, std::size_t{1} << (2 * kRank)> places{};
  for (std::size_t i = 0; i < places.size(); ++i) {
    int of[kRank];
    for (int k = 0; k < kRank; ++k)
      of[k] = static_cast<int>(i >> (2 * k)) & 3;
    std::sort(of, of + kRank);
    for (std::size_t at = 0; at < kCount; ++at)
      if (std::equal(of, of + kRank, all[at]))
        places[i] = static_cast<std::uint8_t>(at);
  }
  return places;
}
constexpr auto kThirdPlaces = places_of(kThird);
constexpr auto kFourthPlaces = places_of(kFourth);
constexpr std::size_t third_at(int i, int j, int k) {
  return kThirdPlaces[static_cast<std::size_t>(i | j << 2 | k << 4)];
}
constexpr std::size_t fourth_at(int i, int j, int k, int l) {
  return kFourthPlaces[static_cast<std::size_t>(i | j << 2 | k << 4 | l << 6)];
}
/// How often a term stands in second(r, r) and third(r, r, r).
constexpr double kSecondTimes[6] = {1, 1, 1, 2, 2, 2};
constexpr double kThirdTimes[10] = {1, 1, 1, 3, 3, 3, 3, 3, 3, 6};
/// Of the derivatives of r / |r|^3: -3 r r / |r|^5, half of 15 r r r / |r|^7.
constexpr double kOfSecond = -3;
constexpr double kOfThird = 7.5;
/// More than the root of 24 * 105 over 6, which docs/proofs.md derives.
constexpr double kOfFourth = 8.3667;

struct Extent {
  double lo[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, hi[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  void add(const double (&p)[3]) {
    for (int a = 0; a < 3; ++a) {
      lo[a] = std::min(lo[a], p[a]);
      hi[a] = std::max(hi[a], p[a]);
    }
  }
  double middle(int a) const { return .5 * lo[a] + .5 * hi[a]; }
  double half_diagonal() const {
    double squares = 0;
    for (int a = 0; a < 3; ++a)
      squares += (hi[a] - middle(a)) * (hi[a] - middle(a));
    return std::sqrt(squares) * kRoundedUp;
  }
};

using Corners = double[3][3];

/// A cluster while it is made.
struct Cluster {
  Extent box;
  double center[3] = {}, radius = 0;
  double area = 0, offset[3] = {}, spread = 0;  ///< sums of 1, y and y y, of the area
  double normal[3] = {}, second[6] = {}, third[10] = {}, fourth[15] = {};

  void set_center() {
    for (int a = 0; a < 3; ++a)
      center[a] = box.middle(a);
  }

  void add(const Corners& corner) {
    double v[3][3], middle[3], e[3], f[3];
    for (int a = 0; a < 3; ++a) {
      for (int k = 0; k < 3; ++k)
        v[k][a] = corner[k][a] - center[a];
      middle[a] = (v[0][a] + v[1][a] + v[2][a]) / 3;
      e[a] = corner[1][a] - corner[0][a];
      f[a] = corner[2][a] - corner[0][a];
    }
    for (const auto& p : v)
      reach(std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]));
    double n[3], squares = 0;
    for (int a = 0; a < 3; ++a) {
      n[a] = .5 * (e[(a + 1) % 3] * f[(a + 2) % 3] - e[(a + 2) % 3] * f[(a + 1) % 3]);
      normal[a] += n[a];
      squares += n[a] * n[a];
    }
    // the mean of y y is a twelfth of that of the corners and nine times that of the middle
    const auto of_two = [&](int i, int j) {
      const double corners = v[0][i] * v[0][j] + v[1][i] * v[1][j] + v[2][i] * v[2][j];
      return (corners + 9 * middle[i] * middle[j]) / 12;
    };
    const double own = std::sqrt(squares);
    area += own;
    spread += own * (of_two(0, 0) + of_two(1, 1) + of_two(2, 2));
    for (int a = 0; a < 3; ++a)
      offset[a] += own * middle[a];
    for (int m = 0; m < 6; ++m) {
      const auto [i, j] = kSecond[m];
      second[m] += .5 * (n[i] * middle[j] + n[j] * middle[i]);
    }
    for (int m = 0; m < 10; ++m) {
      const auto [i, j, k] = kThird[m];
      third[m] += (n[i] * of_two(j, k) + n[j] * of_two(i, k) + n[k] * of_two(i, j)) / 3;
    }
    double of_three[10];  // the mean of y y y
    for (int m = 0; m < 10; ++m) {
      const auto [i, j, k] = kThird[m];
      double sum = 27 * middle[i] * middle[j] * middle[k];
      for (const auto& p : v)
        sum += 3 * (p[i] * p[j] * middle[k] + p[i] * p[k] * middle[j] + p[j] * p[k] * middle[i]) +
               2 * p[i] * p[j] * p[k];
      of_three[m] = sum / 60;
    }
    add_fourth(n, of_three);
  }

  /// Adds a cluster of another center: its places are s further away.
  void add(const Cluster& o) {
    const double s[3] = {o.center[0] - center[0], o.center[1] - center[1], o.center[2] - center[2]};
    reach(std::sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]) + o.radius);
    const auto two = [&](int i, int j) { return o.second[i == j ? i : i + j + 2]; };
    const double* const n = o.normal;
    area += o.area;
    spread += o.spread;
    for (int a = 0; a < 3; ++a) {
      normal[a] += n[a];
      offset[a] += o.offset[a] + s[a] * o.area;
      spread += s[a] * (2 * o.offset[a] + s[a] * o.area);
    }
    for (int m = 0; m < 6; ++m) {
      const auto [i, j] = kSecond[m];
      second[m] += o.second[m] + .5 * (n[i] * s[j] + n[j] * s[i]);
    }
    for (int m = 0; m < 10; ++m) {
      const auto [i, j, k] = kThird[m];
      third[m] += o.third[m] + 2 * (two(i, j) * s[k] + two(i, k) * s[j] + two(j, k) * s[i]) / 3 +
                  (n[i] * s[j] * s[k] + n[j] * s[i] * s[k] + n[k] * s[i] * s[j]) / 3;
    }
    double cubes[10];
    for (int m = 0; m < 10; ++m)
      cubes[m] = s[kThird[m][0]] * s[kThird[m][1]] * s[kThird[m][2]];
    add_fourth(o.normal, cubes);
    const double thrice[3] = {3 * s[0], 3 * s[1], 3 * s[2]};
    add_fourth(thrice, o.third);
    for (int m = 0; m < 15; ++m) {
      const auto [i, j, k, l] = kFourth[m];
      fourth[m] += o.fourth[m] + .5 * (s[i] * s[j] * two(k, l) + s[i] * s[k] * two(j, l) +
                                       s[i] * s[l] * two(j, k) + s[j] * s[k] * two(i, l) +
                                       s[j] * s[l] * two(i, k) + s[k] * s[l] * two(i, j));
    }
  }

  /// Ends the sums: takes out what is the same in all directions, whose solid angle is 0.
  void finish() {
    radius = std::min(radius, box.half_diagonal());
    const double mean = (second[0] + second[1] + second[2]) / 3;
    for (int a = 0; a < 3; ++a)
      second[a] -= mean;
    const auto three = [&](int i, int j, int k) { return third[third_at(i, j, k)]; };
    double along[3];
    for (int a = 0; a < 3; ++a)
      along[a] = (three(0, 0, a) + three(1, 1, a) + three(2, 2, a)) / 5;
    for (int m = 0; m < 10; ++m) {
      const auto [i, j, k] = kThird[m];
      third[m] -= (i == j ? along[k] : 0) + (i == k ? along[j] : 0) + (j == k ? along[i] : 0);
    }
    remove_traces();
  }

  void store(WindingRow& row, std::size_t at) const {
    row.radius[at] = radius;
    row.area[at] = area * kRoundedUp;
    row.spread[at] = (spread + radius * radius * area * kLost) * kRoundedUp;
    row.fourth[at] = (kOfFourth * fourth_length() + radius * row.spread[at] * kLost) * kRoundedUp;
    for (int a = 0; a < 3; ++a) {
      row.center[a][at] = center[a];
      row.normal[a][at] = normal[a];
    }
    for (int m = 0; m < 6; ++m)
      row.second[m][at] = kOfSecond * kSecondTimes[m] * second[m];
    for (int m = 0; m < 10; ++m)
      row.third[m][at] = kOfThird * kThirdTimes[m] * third[m];
  }

 private:
  /// Adds the symmetric part of a vector times a symmetric tensor.
  void add_fourth(const double (&n)[3], const double (&three)[10]) {
    for (int m = 0; m < 15; ++m) {
      const auto [i, j, k, l] = kFourth[m];
      fourth[m] += .25 * (n[i] * three[third_at(j, k, l)] + n[j] * three[third_at(i, k, l)] +
                          n[k] * three[third_at(i, j, l)] + n[l] * three[third_at(i, j, k)]);
    }
  }
  /// Takes out of fourth what is the same in all directions.
  void remove_traces() {
    double trace[3][3], sum = 0;
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l)
        trace[k][l] = fourth[fourth_at(0, 0, k, l)] + fourth[fourth_at(1, 1, k, l)] +
                      fourth[fourth_at(2, 2, k, l)];
    for (int k = 0; k < 3; ++k)
      sum += trace[k][k];
    const auto same = [](int i, int j) { return i == j ? 1. : 0.; };
    for (int m = 0; m < 15; ++m) {
      const auto [i, j, k, l] = kFourth[m];
      fourth[m] -=
          (same(i, j) * trace[k][l] + same(i, k) * trace[j][l] + same(i, l) * trace[j][k] +
           same(j, k) * trace[i][l] + same(j, l) * trace[i][k] + same(k, l) * trace[i][j]) /
              7 -
          sum * (same(i, j) * same(k, l) + same(i, k) * same(j, l) + same(i, l) * same(j, k)) / 35;
    }
  }
  /// The root of the sum of all 81 squared components, whose squares may underflow or overflow.
  double fourth_length() const {
    double largest = 0;
    for (const double x : fourth)
      largest = std::max(largest, std::abs(x));
    if (!(largest > 0))
      return 0;
    double squares = 0;
    for (int m = 0; m < 15; ++m)
      squares += kFourthTimes[m] * (fourth[m] / largest) * (fourth[m] / largest);
    return largest * std::sqrt(squares);
  }
  void reach(double distance) { radius = std::max(radius, distance * kRoundedUp); }
};

struct OrderedTriangle {
  float at[3];
  std::uint32_t id;
};

std::vector<OrderedTriangle> ordered(const GeometrySpans& geometry,
                                     const Triangle::Source& triangles) {
  std::vector<OrderedTriangle> placed;
  placed.reserve(triangles.size());
  each_visible_run(geometry, [&](std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t i = first; i < end; ++i) {
      const Triangle::Fields<float> t = triangles[i];
      float differences = 0;  // 0, or a NaN
      for (const auto& corner : t.corner)
        for (const float x : corner)
          differences += x - x;
      if (differences != 0)
        continue;  // grids leave it out as well
      OrderedTriangle& one = placed.emplace_back();
      one.id = i;
      for (int a = 0; a < 3; ++a) {
        const auto [lo, hi] = std::minmax({t.corner[0][a], t.corner[1][a], t.corner[2][a]});
        one.at[a] = .5f * lo + .5f * hi;
      }
    }
  });
  PackedOrder({1, 1, 1}).sort(std::span(placed));
  return placed;
}

/// Unused positions of the last block hold NaN corners.
void write_block(const Triangle::Source& triangles,
                 std::span<const OrderedTriangle> of,
                 TriangleBlock& block) {
  constexpr float kNoCorner = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < kBlock; ++i) {
    Triangle::Fields<float> t{{{kNoCorner, kNoCorner, kNoCorner},
                               {kNoCorner, kNoCorner, kNoCorner},
                               {kNoCorner, kNoCorner, kNoCorner}}};
    if (i < of.size())
      t = triangles[of[i].id];
    block.id[i] = i < of.size() ? of[i].id : kNoPrimitive;
    for (int a = 0; a < 3; ++a) {
      block.a[a][i] = t.corner[0][a];
      block.b[a][i] = t.corner[1][a];
      block.c[a][i] = t.corner[2][a];
    }
  }
}

Cluster cluster_of(const Triangle::Source& triangles, std::span<const OrderedTriangle> of) {
  Cluster cluster;
  const auto each = [&](const auto& visit) {
    for (const OrderedTriangle& one : of) {
      const Triangle::Fields<float> t = triangles[one.id];
      Corners corner;
      for (int k = 0; k < 3; ++k)
        std::copy(t.corner[k], t.corner[k] + 3, corner[k]);
      visit(corner);
    }
  };
  each([&](const Corners& corner) {
    for (const auto& p : corner)
      cluster.box.add(p);
  });
  cluster.set_center();
  each([&](const Corners& corner) { cluster.add(corner); });
  cluster.finish();
  return cluster;
}

Cluster cluster_of(std::span<const Cluster> parts) {
  Cluster cluster;
  for (const Cluster& part : parts) {
    cluster.box.add(part.box.lo);
    cluster.box.add(part.box.hi);
  }
  cluster.set_center();
  for (const Cluster& part : parts)
    cluster.add(part);
  cluster.finish();
  return cluster;
}

/// Calls make(part, i) for each eight items that follow each other.
template <class Item, class Make>
void each_eight(std::span<Item> items, const Make& make) {
  for (std::size_t i = 0; i < items.size(); i += kBlock)
    make(items.subspan(i, std::min<std::size_t>(kBlock, items.size() - i)), i / kBlock);
}

}  // namespace

WindingTree::WindingTree(const GeometrySpans& geometry) {
  const Triangle::Source triangles(geometry);
  const std::vector<OrderedTriangle> placed = ordered(geometry, triangles);
  blocks.resize(rows_of(placed.size()));
  std::vector<Cluster> clusters(blocks.size());
  each_eight(std::span(placed), [&](std::span<const OrderedTriangle> of, std::size_t i) {
    write_block(triangles, of, blocks[i]);
    clusters[i] = cluster_of(triangles, of);
  });
  view.triangles = static_cast<std::uint32_t>(placed.size());
  while (!clusters.empty()) {
    view.first[view.levels] = static_cast<std::uint32_t>(rows.size());
    view.clusters[view.levels++] = static_cast<std::uint32_t>(clusters.size());
    std::vector<Cluster> above(rows_of(clusters.size()));
    each_eight(std::span(std::as_const(clusters)),
               [&](std::span<const Cluster> parts, std::size_t i) {
                 WindingRow& row = rows.emplace_back();
                 for (std::size_t k = 0; k < parts.size(); ++k)
                   parts[k].store(row, k);
                 above[i] = cluster_of(parts);
               });
    view.area = above[0].area * kRoundedUp;
    clusters = clusters.size() > kBlock ? std::move(above) : std::vector<Cluster>();
  }
  view.rows = rows.data();
  view.blocks = blocks.data();
}

}  // namespace grelha
