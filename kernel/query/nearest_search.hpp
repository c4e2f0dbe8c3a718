#pragma once
// The search for the point of a scene that is nearest to another: down levels of boxes, the nearest
// first.

#include "grelha/distance.hpp"
#include "kernel/grid/view.hpp"
#include "kernel/shapes/distance_bound.hpp"
#include "kernel/shapes/foot.hpp"
#include "kernel/shapes/nearest.hpp"

namespace grelha::GRELHA_ISA {

/// Times distance: error of what doubles say of it, and of coordinates (docs/numerics.md).
inline constexpr double kDistanceError = 0x1p-44;

/// Of some boxes of a row, by bits, the one that is nearest.
[[gnu::always_inline]] inline int nearest_of(unsigned boxes, const float (&beside)[kBlock]) {
  int nearest = __builtin_ctz(boxes);
  float least = beside[nearest];
  each_bit(boxes & (boxes - 1), [&](int k) {
    const bool is_less = beside[k] < least;
    least = is_less ? beside[k] : least;
    nearest = is_less ? k : nearest;
  });
  return nearest;
}

/// Boxes that wait to be looked into.
class BoxStack {
 public:
  struct Entry {
    float beside;  ///< see SearchBall
    int level;     ///< of the row that the box stands for; -1: a cell
    std::uint32_t index;
  };

  bool empty() const { return size_ == 0; }
  Entry pop() { return entry_[--size_]; }
  /// Boxes k of a row, `first` + k on the level below, by bits; the nearest is the next.
  void push(unsigned boxes, const float (&beside)[kBlock], int level, std::uint32_t first) {
    if (boxes == 0)
      return;
    const auto put = [&](int k) {
      entry_[size_++] = {beside[k], level, first + static_cast<std::uint32_t>(k)};
    };
    const int nearest = nearest_of(boxes, beside);
    each_bit(boxes & ~(1u << nearest), put);
    put(nearest);
  }

 private:
  /// A node leaves its eight children, of which one is taken.
  Entry entry_[(kBlock - 1) * BoxLevelsView::kMostLevels + kBlock];
  int size_ = 0;
};

/// Finds the nearest point. Of each primitive that may be nearest doubles tell the distance, which
/// is a function of point and primitive alone. So the order of the search never shows.
class NearestSearch {
 public:
  NearestSearch(const SceneView& scene, const float (&p)[3], double radius)
      : scene_(scene),
        p_{p[0], p[1], p[2]},
        slack_(kDistanceError * static_cast<double>(farthest_coordinate(scene, p))),
        best_(radius),
        ball_(p, scene.box_lo, scene.box_hi) {
    ball_.shrink(widened(radius));
  }

  /// Something is no further away than a point of a surface.
  void expect(const double (&point)[3]) {
    const Point way{point[0] - p_[0], point[1] - p_[1], point[2] - p_[2]};
    narrow(length(way));
  }

  void search() {
    int order[kMostGrids];
    const int count = grids_by_distance(order);
    for (int i = 0; i < count; ++i)
      search(scene_.grids[order[i]]);
    look_at_lists(scene_.outside, 0);
    const std::uint32_t planes = scene_.geometry.ids.begin(PrimitiveKind::kPlane);
    for (std::uint32_t i = 0; i < scene_.geometry.of<Plane>().count; ++i)
      look(planes + i);
  }

  const double (&at() const)[3] { return at_; }
  std::uint32_t id() const { return id_; }
  ClosestPoint found() const {
    const double(&at)[3] = id_ == kNoPrimitive ? p_ : at_;
    ClosestPoint found;
    found.point = {static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2])};
    if (id_ != kNoPrimitive)
      found.distance = static_cast<float>(best_);
    found.id = id_;
    return found;
  }

 private:
  static float farthest_coordinate(const SceneView& scene, const float (&p)[3]) {
    float most = 0;
    for (int a = 0; a < 3; ++a)
      most = max(max(most, magnitude(p[a])),
                 max(magnitude(scene.box_lo[a]), magnitude(scene.box_hi[a])));
    return most;
  }
  /// What true distances may be of primitives that doubles find within a radius.
  double widened(double radius) const { return radius * (1 + kDistanceError) + slack_; }

  /// Numbers of the grids, the nearest first.
  int grids_by_distance(int (&order)[kMostGrids]) const {
    double squared[kMostGrids];
    int count = 0;
    for (; count < scene_.grid_count; ++count) {
      const double distance = squared_distance(scene_.grids[count]);
      int at = count;
      for (; at > 0 && squared[at - 1] > distance; --at) {
        squared[at] = squared[at - 1];
        order[at] = order[at - 1];
      }
      squared[at] = distance;
      order[at] = count;
    }
    return count;
  }
  double squared_distance(const GridView& g) const {
    double sum = 0;
    for (int a = 0; a < 3; ++a) {
      const double hi = g.lo[a] + g.n[a] * g.cell[a];
      const double way = max(max(g.lo[a] - p_[a], p_[a] - hi), 0.);
      sum += way * way;
    }
    return sum;
  }

  void search(const GridView& g) {
    BoxStack stack;
    float beside[kBlock];
    const auto push = [&](int level, std::uint32_t row) {
      const unsigned near = boxes_near(ball_, g.levels.rows[g.levels.first[level] + row], beside);
      stack.push(near, beside, level - 1, row * kBlock);
    };
    if (g.levels.levels > 0)
      push(g.levels.levels - 1, 0);
    while (!stack.empty()) {
      const BoxStack::Entry box = stack.pop();
      if (box.beside > ball_.reach)
        continue;
      if (box.level >= 0)
        push(box.level, box.index);
      else
        look_at_lists(g.lists, g.levels.cells[box.index]);
    }
  }

  void look_at_lists(const CellLists& lists, std::size_t cell) {
    if (const Triangle::CellList& list = lists.of<Triangle>(); list.first) {
      if (list.boxes)
        look_at_boxes(list, list.first[cell], list.first[cell + 1]);
      else
        for (std::uint32_t i = list.first[cell]; i < list.first[cell + 1]; ++i)
          look_at_block(list.blocks[i]);
    }
    ArrayShapes::for_each([&]<class Shape>() {
      const typename Shape::CellList& list = lists.of<Shape>();
      if (list.first)
        look_at_array<Shape>(list, list.first[cell], list.first[cell + 1]);
    });
  }

  /// Blocks whose boxes stand at places first to end - 1.
  void look_at_boxes(const Triangle::CellList& list, std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t row = first / kBlock; row * kBlock < end; ++row) {
      const std::uint32_t begin = row * kBlock;
      float beside[kBlock];
      unsigned near = boxes_near(ball_, list.boxes[row], beside);
      near &= first > begin ? ~0u << (first - begin) : ~0u;
      near &= end - begin < kBlock ? (1u << (end - begin)) - 1 : ~0u;
      while (near != 0) {
        const int k = nearest_of(near, beside);
        near &= ~(1u << k);
        if (beside[k] > ball_.reach)
          break;
        look_at_block(list.blocks[list.first_block[row] + static_cast<std::uint32_t>(k)]);
      }
    }
  }

  void look_at_block(const TriangleBlock& block) {
    const unsigned near = triangles_near(ball_, block);
    constexpr unsigned kPart = (1u << kWidth<VDouble>)-1;
    for (int i = 0; i < kBlock; i += kWidth<VDouble>)
      if (const unsigned lanes = near >> i & kPart; lanes != 0)
        look_at_triangles(block, i, lanes);
  }

  /// Triangles i, i + 1, ... of a block, by bits, side by side in double.
  void look_at_triangles(const TriangleBlock& block, int i, unsigned lanes) {
    const auto corner = [i](const float(&c)[3][kBlock]) {
      return Vec3<VDouble>{grelha::GRELHA_ISA::take<VDouble>(c[0] + i),
                           grelha::GRELHA_ISA::take<VDouble>(c[1] + i),
                           grelha::GRELHA_ISA::take<VDouble>(c[2] + i)};
    };
    const Vec3<VDouble> p{VDouble(p_[0]), VDouble(p_[1]), VDouble(p_[2])};
    const Vec3<VDouble> a = corner(block.a), b = corner(block.b), c = corner(block.c);
    const Vec3<VDouble> n = cross(b - a, c - a);
    const unsigned thin = bits(is_thin(b - a, c - a, n)) & lanes;
    const Vec3<VDouble> at = nearest_on_triangle(p, a, b, c, n);
    const VDouble distance = length(at - p);
    const unsigned near = bits(distance <= VDouble(best_)) & lanes & ~thin;
    each_bit(thin, [&](int k) { look(block.id[i + k]); });
    if (near == 0)
      return;
    double of[kWidth<VDouble>], x[kWidth<VDouble>], y[kWidth<VDouble>], z[kWidth<VDouble>];
    store(of, distance);
    store(x, at.x);
    store(y, at.y);
    store(z, at.z);
    double least = of[__builtin_ctz(near)];
    each_bit(near, [&](int k) { least = min(of[k], least); });
    each_bit(near & bits(distance == VDouble(least)), [&](int k) {
      take(block.id[i + k], of[k], {x[k], y[k], z[k]});
    });
  }

  template <class Shape>
  void look_at_array(const typename Shape::CellList& list, std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t i = first; i < end; i += kWidth<Block>) {
      unsigned near = ~0u;  // a kind may do without bounds
      if constexpr (requires { primitives_near(ball_, list.fields, i); })
        near = primitives_near(ball_, list.fields, i);
      near &= end - i < kWidth<Block> ? (1u << (end - i)) - 1 : (1u << kWidth<Block>)-1;
      each_bit(near, [&](int k) { look(list.id[i + static_cast<std::uint32_t>(k)]); });
    }
  }

  void look(std::uint32_t id) {
    const Foot foot = foot_on(scene_.geometry, id, p_);
    take(id, foot.distance, foot.at);
  }

  void take(std::uint32_t id, double distance, const double (&at)[3]) {
    if (!(distance < best_ || (distance == best_ && id < id_)))
      return;
    id_ = id;
    for (int a = 0; a < 3; ++a)
      at_[a] = at[a];
    best_ = distance;
    narrow(distance);
  }
  /// Something is surely this near.
  void narrow(double distance) {
    const double radius = widened(distance);
    if (radius < static_cast<double>(ball_.radius))
      ball_.shrink(radius);
  }

  const SceneView& scene_;
  const double p_[3];
  const double slack_;
  double best_;
  SearchBall ball_;
  double at_[3] = {};
  std::uint32_t id_ = kNoPrimitive;
};

inline bool is_finite(const float (&p)[3]) {
  return p[0] - p[0] == 0 && p[1] - p[1] == 0 && p[2] - p[2] == 0;
}

inline bool is_nearer(const Float3& a, const Float3& b, double distance) {
  const double x = static_cast<double>(a.x) - static_cast<double>(b.x);
  const double y = static_cast<double>(a.y) - static_cast<double>(b.y);
  const double z = static_cast<double>(a.z) - static_cast<double>(b.z);
  return x * x + y * y + z * z < distance * distance;
}

/// Finds the closest points of many, of which neighbours are near each other.
inline void closest_points(const SceneView& scene,
                           const Float3* points,
                           std::size_t count,
                           float radius,
                           ClosestPoint* found) {
  bool any = false;
  double last[3] = {}, last_distance = 0;
  const Float3* before = points;
  for (std::size_t i = 0; i < count; ++i) {
    const float p[3] = {points[i].x, points[i].y, points[i].z};
    found[i] = {points[i]};
    if (!is_finite(p) || !(radius >= 0))
      continue;
    NearestSearch search(scene, p, static_cast<double>(radius));
    // An answer bounds that of a point nearer than it. To ask for no other saves waiting for it.
    if (any && is_nearer(points[i], *before, last_distance))
      search.expect(last);
    search.search();
    found[i] = search.found();
    any = search.id() != kNoPrimitive;
    before = points + i;
    last_distance = static_cast<double>(found[i].distance);
    for (int a = 0; a < 3; ++a)
      last[a] = search.at()[a];
  }
}

}  // namespace grelha::GRELHA_ISA
