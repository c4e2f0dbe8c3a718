#include "grelha/mesh_check.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "kernel/base/exact_numbers.hpp"
#include "kernel/world/world_impl.hpp"
#include "kernel/world/visible.hpp"
#include "kernel/shapes/triangle.hpp"

namespace grelha {
namespace {

constexpr std::uint32_t kUnseen = ~std::uint32_t{0};

/// One vertex for each place.
class VertexPositions {
 public:
  VertexPositions(const TriangleSpans& t, const std::vector<std::uint32_t>& triangles)
      : t_(t), of_(t.vertex_count(), kUnseen) {
    std::size_t used = 0;
    for (const std::uint32_t i : triangles)
      for (const std::uint32_t vertex : {t.a[i], t.b[i], t.c[i]})
        used += std::exchange(of_[vertex], vertex) == kUnseen;
    table_.assign(std::bit_ceil(2 * used + 1), kUnseen);
    for (std::uint32_t v = 0; v < of_.size(); ++v)
      if (of_[v] != kUnseen)
        of_[v] = first_at(v);
  }

  /// The lowest vertex in the place of another.
  std::uint32_t of(std::uint32_t vertex) const { return of_[vertex]; }
  std::size_t count() const { return count_; }

 private:
  bool is_same(std::uint32_t v, std::uint32_t w) const {
    return t_.x[v] == t_.x[w] && t_.y[v] == t_.y[w] && t_.z[v] == t_.z[w];
  }
  std::uint64_t hash(std::uint32_t v) const {
    std::uint64_t h = 0;
    for (const float x : {t_.x[v], t_.y[v], t_.z[v]}) {
      h = (h ^ std::bit_cast<std::uint32_t>(x + 0.f)) * 0x9E3779B97F4A7C15u;  // no zero is -0
      h ^= h >> 29;
    }
    return h;
  }
  std::uint32_t first_at(std::uint32_t v) {
    const std::size_t mask = table_.size() - 1;
    for (std::size_t at = hash(v) & mask;; at = (at + 1) & mask) {
      if (table_[at] != kUnseen && !is_same(table_[at], v))
        continue;
      count_ += table_[at] == kUnseen;
      return table_[at] = std::min(table_[at], v);
    }
  }

  const TriangleSpans& t_;
  std::vector<std::uint32_t> of_;     ///< [vertices] kUnseen: of no triangle
  std::vector<std::uint32_t> table_;  ///< open addressing
  std::size_t count_ = 0;
};

/// An edge of a triangle, or a triangle, by its vertices in ascending order.
struct CornerSet {
  std::uint32_t vertex[3];
  std::uint32_t triangle;
  std::uint32_t side;  ///< of the triangle; the edge goes from corner `side` to the next

  bool is_same(const CornerSet& o) const { return std::equal(vertex, vertex + 3, o.vertex); }
  bool operator<(const CornerSet& o) const {
    return std::lexicographical_compare(vertex + 1, vertex + 3, o.vertex + 1, o.vertex + 3) ||
           (std::equal(vertex + 1, vertex + 3, o.vertex + 1) &&
            std::pair(triangle, side) < std::pair(o.triangle, o.side));
  }
};

/// Calls visit(items) for each run of items of the same vertices, ordered by triangle. Items of one
/// first vertex are put together first, so the time does not grow faster than their number.
template <class Visit>
void each_same(const std::vector<CornerSet>& items, std::size_t vertices, const Visit& visit) {
  std::vector<std::size_t> first(vertices + 1);
  for (const CornerSet& item : items)
    ++first[item.vertex[0] + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<CornerSet> sorted(items.size());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (const CornerSet& item : items)
    sorted[next[item.vertex[0]]++] = item;
  for (std::size_t v = 0; v < vertices; ++v) {
    const std::span<CornerSet> own(sorted.data() + first[v], first[v + 1] - first[v]);
    std::sort(own.begin(), own.end());
    for (std::size_t i = 0; i < own.size();) {
      std::size_t end = i + 1;
      while (end < own.size() && own[end].is_same(own[i]))
        ++end;
      visit(own.subspan(i, end - i));
      i = end;
    }
  }
}

/// True if a triangle has no area: exact.
bool is_flat(const float (&corner)[3][3]) {
  double edge[2][3];
  for (int k = 0; k < 2; ++k)
    for (int a = 0; a < 3; ++a)
      edge[k][a] = double{corner[k + 1][a]} - double{corner[0][a]};
  for (int a = 0; a < 3; ++a) {
    const double first = edge[0][(a + 1) % 3] * edge[1][(a + 2) % 3];
    const double second = edge[0][(a + 2) % 3] * edge[1][(a + 1) % 3];
    // each is off by 3 u, their difference by one more
    if (std::abs(first - second) > 0x1p-50 * (std::abs(first) + std::abs(second)))
      return false;
  }
  const ExactVector n = cross(difference(corner[1], corner[0]), difference(corner[2], corner[0]));
  return n.x.sign() == 0 && n.y.sign() == 0 && n.z.sign() == 0;
}

/// Throws std::invalid_argument where arrays of triangles have unequal lengths, or a triangle names
/// a vertex that is not there.
void expect_vertices(TriangleSpans t) {
  if (t.material.empty())
    t.material = t.a;
  if (!Triangle::is_even(t))
    throw std::invalid_argument("arrays of one kind of primitive have unequal lengths");
  for (const Indices corner : {t.a, t.b, t.c})
    for (const std::uint32_t vertex : corner)
      if (vertex >= t.vertex_count())
        throw std::invalid_argument("a triangle names a vertex that is not there");
}

class MeshChecker {
 public:
  MeshChecker(const GeometrySpans& g, std::uint32_t first_id)
      : t_(g.triangles),
        first_id_(first_id),
        checked_(finite_triangles(g)),
        positions_(t_, checked_) {
    found_.triangles = checked_.size();
    found_.vertices = positions_.count();
  }

  MeshCheck check() {
    check_triangles();
    check_edges();
    trim(found_.open_edges);
    trim(found_.inconsistent_edges);
    trim(found_.nonmanifold_edges);
    trim(found_.duplicate_triangles);
    trim(found_.degenerate_triangles);
    trim(found_.nonfinite_triangles);
    return std::move(found_);
  }

 private:
  std::uint32_t vertex(std::size_t i, std::uint32_t k) const {
    return (k == 0 ? t_.a : k == 1 ? t_.b : t_.c)[i];
  }
  std::uint32_t position_of(std::size_t i, std::uint32_t k) const {
    return positions_.of(vertex(i, k));
  }
  bool has_three_positions(std::size_t i) const {
    return position_of(i, 0) != position_of(i, 1) && position_of(i, 1) != position_of(i, 2) &&
           position_of(i, 2) != position_of(i, 0);
  }

  void check_triangles() {
    std::vector<CornerSet> items;
    items.reserve(found_.triangles);
    for (const std::uint32_t i : checked_) {
      CornerSet& item = items.emplace_back(
          CornerSet{{position_of(i, 0), position_of(i, 1), position_of(i, 2)}, i, 0});
      std::sort(item.vertex, item.vertex + 3);
      float corner[3][3];
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t v = vertex(i, k);
        const float at[3] = {t_.x[v], t_.y[v], t_.z[v]};
        std::copy(at, at + 3, corner[k]);
      }
      if (!has_three_positions(i) || is_flat(corner))
        found_.degenerate_triangles.first.push_back(first_id_ + i);
    }
    each_same(items, t_.vertex_count(), [&](std::span<const CornerSet> same) {
      for (const CornerSet& item : same.subspan(1))
        found_.duplicate_triangles.first.push_back(first_id_ + item.triangle);
    });
  }

  void check_edges() {
    std::vector<CornerSet> items;
    items.reserve(3 * found_.triangles);
    for (const std::uint32_t i : checked_)
      for (std::uint32_t k = 0; has_three_positions(i) && k < 3; ++k) {
        const auto [low, high] = std::minmax({position_of(i, k), position_of(i, (k + 1) % 3)});
        items.push_back({{low, high, 0}, i, k});
      }
    each_same(items, t_.vertex_count(), [&](std::span<const CornerSet> same) { check_edge(same); });
  }
  void check_edge(std::span<const CornerSet> same) {
    const CornerSet& first = same[0];
    const MeshEdge edge{first_id_ + first.triangle,
                        vertex(first.triangle, first.side),
                        vertex(first.triangle, (first.side + 1) % 3)};
    const auto up = static_cast<std::size_t>(
        std::count_if(same.begin(), same.end(), [&](const CornerSet& item) {
          return position_of(item.triangle, item.side) == item.vertex[0];
        }));
    ++found_.edges;
    if (same.size() % 2 != 0)
      found_.open_edges.first.push_back(edge);
    else if (2 * up != same.size())
      found_.inconsistent_edges.first.push_back(edge);
    if (same.size() > 2)
      found_.nonmanifold_edges.first.push_back(edge);
  }

  /// Counts what was found, and keeps the first.
  static void trim(Findings<MeshEdge>& found) {
    trim(found, [](const MeshEdge& a, const MeshEdge& b) {
      return std::tie(a.id, a.from, a.to) < std::tie(b.id, b.from, b.to);
    });
  }
  static void trim(Findings<std::uint32_t>& found) { trim(found, std::less<>()); }
  template <class Item, class Less>
  static void trim(Findings<Item>& found, const Less& less) {
    auto& all = found.first;
    found.count = all.size();
    const std::size_t kept = std::min(all.size(), Findings<Item>::kMost);
    std::partial_sort(
        all.begin(), all.begin() + static_cast<std::ptrdiff_t>(kept), all.end(), less);
    all.resize(kept);
    all.shrink_to_fit();
  }

  /// Those that are visible. Queries leave out the others as well.
  std::vector<std::uint32_t> finite_triangles(const GeometrySpans& g) {
    std::vector<std::uint32_t> finite;
    each_visible_run(g, [&](std::uint32_t first, std::uint32_t end) {
      for (std::uint32_t i = first; i < end; ++i) {
        float differences = 0;  // 0, or a NaN
        for (const std::uint32_t v : {t_.a[i], t_.b[i], t_.c[i]})
          differences += (t_.x[v] - t_.x[v]) + (t_.y[v] - t_.y[v]) + (t_.z[v] - t_.z[v]);
        if (differences == 0)
          finite.push_back(i);
        else
          found_.nonfinite_triangles.first.push_back(first_id_ + i);
      }
    });
    return finite;
  }

  const TriangleSpans& t_;
  const std::uint32_t first_id_;
  MeshCheck found_;
  const std::vector<std::uint32_t> checked_;  ///< triangles
  const VertexPositions positions_;
};

}  // namespace

MeshCheck check_mesh(const SceneSpans& scene) {
  const GeometrySpans& g = scene.geometry;
  expect_vertices(g.triangles);
  expect_objects(g);
  const std::size_t first_id = g.planes.size() + g.spheres.size();
  return MeshChecker(g, static_cast<std::uint32_t>(first_id)).check();
}

const MeshCheck& check_mesh(const World& world) {
  const World::Impl& w = world.impl();
  return w.mesh_check.get([&] { return check_mesh(w.scene); });
}

}  // namespace grelha
