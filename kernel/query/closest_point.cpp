#include <algorithm>
#include <cmath>
#include <limits>

#include "grelha/all_hits.hpp"
#include "grelha/distance.hpp"
#include "kernel/grid/world_impl.hpp"
#include "kernel/query/runs.hpp"
#include "kernel/shapes/exact_hits.hpp"
#include "kernel/shapes/nearest.hpp"
#include "kernel/traverse/dda.hpp"

namespace grelha {
namespace {

using scalar::Point;

/// Searches the primitives of a scene for the point nearest to p: grids in cubes of cells that grow
/// around p, until no cell beyond the cube can be nearer.
class NearestSearch {
 public:
  NearestSearch(const SceneView& scene, const Point& p, double radius)
      : scene_(scene), p_(p), best_(radius) {
    const PrimitiveIds& ids = scene.geometry.ids;
    for (std::uint32_t i = 0; i < scene.geometry.of<Plane>().count; ++i)
      look(ids.begin(PrimitiveKind::kPlane) + i);
    look(scene.outside, 0);
    for (int g = 0; g < scene.grid_count; ++g)
      search(scene.grids[g]);
  }

  ClosestPoint found() const {
    if (id_ == kNoPrimitive)
      return {{static_cast<float>(p_.x), static_cast<float>(p_.y), static_cast<float>(p_.z)}};
    return {{static_cast<float>(at_.x), static_cast<float>(at_.y), static_cast<float>(at_.z)},
            static_cast<float>(best_),
            id_};
  }

 private:
  void search(const GridView& g) {
    const double p[3] = {p_.x, p_.y, p_.z};
    int center[3];
    for (int a = 0; a < 3; ++a)
      center[a] = scalar::clamp_cell((p[a] - g.lo[a]) * g.inv_cell[a], g.n[a]);
    const int most = std::max(g.n[0], std::max(g.n[1], g.n[2]));
    // no cell nearer than this many holds anything
    for (int r = g.distance[index_of(g, center)]; r < most; ++r) {
      if (least_distance_beyond(g, center, r - 1) > best_)
        return;
      look_at_shell(g, center, r);
    }
  }

  static std::size_t index_of(const GridView& g, const int (&at)[3]) {
    const auto n = [&](int a) { return static_cast<std::size_t>(g.n[a]); };
    const auto i = [&](int a) { return static_cast<std::size_t>(at[a]); };
    return i(0) + n(0) * (i(1) + n(1) * i(2));
  }

  /// A lower bound of the distance from p to cells more than r from the center; infinity if there
  /// are none.
  double least_distance_beyond(const GridView& g, const int (&center)[3], int r) const {
    if (r < 0)
      return 0;
    const double p[3] = {p_.x, p_.y, p_.z};
    double outside[3];  // from p to the grid along each axis
    for (int a = 0; a < 3; ++a)
      outside[a] = std::max({0., g.lo[a] - p[a], p[a] - (g.lo[a] + g.n[a] * g.cell[a])});
    double least = std::numeric_limits<double>::infinity();
    for (int a = 0; a < 3; ++a) {
      const double x = outside[(a + 1) % 3], y = outside[(a + 2) % 3];
      const auto take = [&](double z) {
        least = std::min(least, std::sqrt(x * x + y * y + z * z));
      };
      if (center[a] - r > 0)
        take(std::max(0., p[a] - (g.lo[a] + (center[a] - r) * g.cell[a])));
      if (center[a] + r + 1 < g.n[a])
        take(std::max(0., (g.lo[a] + (center[a] + r + 1) * g.cell[a]) - p[a]));
    }
    // a primitive stands in the cell that its nearest point lies in; doubles round by less
    return least * (1 - 0x1p-40);
  }

  void look_at_shell(const GridView& g, const int (&center)[3], int r) {
    const auto lo = [&](int a) { return std::max(0, center[a] - r); };
    const auto hi = [&](int a) { return std::min(g.n[a] - 1, center[a] + r); };
    const auto each_side = [&](int a, const auto& visit) {
      if (center[a] - r >= 0)
        visit(center[a] - r);
      if (r > 0 && center[a] + r < g.n[a])
        visit(center[a] + r);
    };
    each_side(2, [&](int z) {
      for (int y = lo(1); y <= hi(1); ++y)
        look_at_line(g, {0, y, z}, 0, lo(0), hi(0));
    });
    const int least = std::max(0, center[2] - r + 1);
    const int most = std::min(g.n[2] - 1, center[2] + r - 1);
    for (int z = least; z <= most; ++z) {
      each_side(1, [&](int y) { look_at_line(g, {0, y, z}, 0, lo(0), hi(0)); });
      each_side(0, [&](int x) {
        const int first = std::max(0, center[1] - r + 1);
        look_at_line(g, {x, 0, z}, 1, first, std::min(g.n[1] - 1, center[1] + r - 1));
      });
    }
  }

  /// Cells first to last of a line along an axis; distances tell how many may be skipped.
  void look_at_line(const GridView& g, const int (&from)[3], int axis, int first, int last) {
    const std::size_t start = index_of(g, from);
    const std::size_t stride = axis == 0 ? 1 : static_cast<std::size_t>(g.n[0]);
    for (int i = first; i <= last;) {
      const std::size_t cell = start + static_cast<std::size_t>(i) * stride;
      const int distance = g.distance[cell];
      if (distance == 0)
        look(g.lists, cell);
      i += std::max(1, distance);
    }
  }

  void look(const CellLists& lists, std::size_t cell) {
    if (const Triangle::CellList& list = lists.of<Triangle>(); list.first)
      look_at_blocks(list, cell);
    ArrayShapes::for_each([&]<class Shape>() {
      const typename Shape::CellList& list = lists.of<Shape>();
      if (list.first)
        for (std::uint32_t i = list.first[cell]; i < list.first[cell + 1]; ++i)
          look(list.id[i]);
    });
  }

  void look_at_blocks(const Triangle::CellList& list, std::size_t cell) {
    const auto [first, end] = list.blocks_of(cell);
    for (std::uint32_t i = first; i < end; ++i) {
      const TriangleBlock& block = list.blocks[i];
      for (int k = 0; k < kBlock && block.id[k] != kNoPrimitive; ++k) {
        const Triangle::Fields<float> triangle = scalar::triangle_of(block, k);
        if (!is_beyond(triangle))
          take(block.id[k], nearest_on(p_, triangle));
      }
    }
  }

  /// True if the box of a triangle is surely further away than what was found.
  bool is_beyond(const Triangle::Fields<float>& triangle) const {
    const double p[3] = {p_.x, p_.y, p_.z};
    double squared = 0;
    for (int a = 0; a < 3; ++a) {
      const auto [lo, hi] =
          std::minmax({triangle.corner[0][a], triangle.corner[1][a], triangle.corner[2][a]});
      const double away = std::max({0., lo - p[a], p[a] - hi});
      squared += away * away;
    }
    return squared * (1 - 0x1p-40) > best_ * best_;
  }

  void look(std::uint32_t id) {
    visit_primitive(
        scene_.geometry, id, [&]<class Shape>(const auto& one) { take(id, nearest_on(p_, one)); });
  }

  void take(std::uint32_t id, const Point& at) {
    const double distance = length(at - p_);
    if (!(distance < best_ || (distance == best_ && id < id_)))
      return;
    best_ = distance;
    at_ = at;
    id_ = id;
  }

  const SceneView& scene_;
  const Point p_;
  double best_;
  Point at_{};
  std::uint32_t id_ = kNoPrimitive;
};

bool is_finite(const Float3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}  // namespace

ClosestPoint closest_point(const World& world, Float3 point, float radius) {
  if (!is_finite(point) || !(radius >= 0))
    return {point};
  return NearestSearch(world.impl().view, {point.x, point.y, point.z}, radius).found();
}

void closest_points(const World& world,
                    std::span<const Float3> points,
                    std::span<ClosestPoint> found,
                    float radius,
                    const QueryOptions& options) {
  expect_same_size(points.size(), found.size(), "points");
  const auto work = [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i)
      found[i] = closest_point(world, points[i], radius);
  };
  each_run(points.size(), options, work, kPoints);
}

float signed_distance(const World& world, Float3 point) {
  const float distance = closest_point(world, point).distance;
  return contains(world, point) ? 0 - distance : distance;  // no zero is -0
}

void signed_distances(const World& world,
                      std::span<const Float3> points,
                      std::span<float> distances,
                      const QueryOptions& options) {
  expect_same_size(points.size(), distances.size(), "points");
  const auto work = [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i)
      distances[i] = signed_distance(world, points[i]);
  };
  each_run(points.size(), options, work, kPoints);
}

}  // namespace grelha
