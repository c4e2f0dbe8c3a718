#pragma once
// The search for the point of a scene that is nearest to another: down levels of boxes, the nearest
// first.

#include "grelha/distance.hpp"
#include "kernel/base/vec3.hpp"
#include "kernel/shapes/cone.hpp"
#include "kernel/shapes/arrays.hpp"
#include "kernel/shapes/sphere.hpp"
#include "kernel/shapes/triangle.hpp"
#include "kernel/grid/view.hpp"
#include "kernel/shapes/foot.hpp"
#include "kernel/shapes/nearest.hpp"

namespace grelha::GRELHA_ISA {

/// A product of vectors: error <= kAlongError * sum of the sizes of its terms, 5 u.
inline constexpr float kAlongError = 8 * kEps;
/// error <= kLengthError * length, 4 u of its square.
inline constexpr float kLengthError = 8 * kEps;
/// SearchBall::min_distance(): error <= kDistanceLost * size of what is seen from afar, 50 u.
inline constexpr float kDistanceLost = 64 * kEps;
/// A point's distance to a cone's axis: error <= kBesideError * (cone + distance to it), 15 u.
inline constexpr float kBesideError = 32 * kEps;
/// More than what underflows in a product, and in a length.
inline constexpr float kLostProduct = 0x1p-140f;
inline constexpr float kLostLength = 0x1p-70f;

/// A point, and how far from it others matter. Squares of distances lose what is small beside them,
/// so far from a scene they are counted from a point o of its box: for e = o - x and r = p - o,
/// (|p - x|^2 - |r|^2) / |r| = e (2 r / |r| + e / |r|). Where p is near, o is p, and |r| is taken
/// to be 1.
class SearchBall {
 public:
  Vec3<Block> center;
  float radius = 0;  ///< of no primitive found so far, infinity
  float reach = 0;   ///< of boxes that the ball reaches, min_distance() is no more

  /// Around p, for boxes within a box.
  SearchBall(const float (&p)[3], const float (&lo)[3], const float (&hi)[3])
      : center{Block(p[0]), Block(p[1]), Block(p[2])}, from_(center) {
    double size = 0, squared = 0, way[3];
    float from[3];
    for (int a = 0; a < 3; ++a) {
      from[a] = min(max(p[a], lo[a]), hi[a]);
      way[a] = static_cast<double>(p[a]) - static_cast<double>(from[a]);
      squared += way[a] * way[a];
      size += static_cast<double>(hi[a]) - static_cast<double>(lo[a]);
    }
    if (!(squared > size * size))
      return;
    away_ = square_root(squared);
    unit_ = 1 / away_;
    lost_ = double{kDistanceLost} * (2 * size + size * size * unit_);
    from_ = {Block(from[0]), Block(from[1]), Block(from[2])};
    const auto twice = [&](double x) { return Block(static_cast<float>(2 * x * unit_)); };
    twice_ = {twice(way[0]), twice(way[1]), twice(way[2])};
  }
  void shrink(double r) {
    const double excess = (r - away_) * (r + away_) * unit_;
    reach = static_cast<float>(excess + 16 * double{kEps} * magnitude(excess) + lost_);
    radius = static_cast<float>(r * (1 + 4 * double{kEps}) + double{kLostLength});
  }
  bool is_far() const { return away_ > 0; }
  /// Of points x: a number that grows with the distance.
  [[gnu::always_inline]] Block min_distance(const Vec3<Block>& x) const {
    const Vec3<Block> e = from_ - x;
    return dot(e, twice_ + Block(static_cast<float>(unit_)) * e);
  }
  /// How fast min_distance() shrinks along each axis.
  [[gnu::always_inline]] Vec3<Block> slope(const Vec3<Block>& x) const {
    return twice_ + Block(static_cast<float>(2 * unit_)) * (from_ - x);
  }

 private:
  Vec3<Block> from_, twice_{Block(0), Block(0), Block(0)};
  double away_ = 0, unit_ = 1;
  double lost_ = double{kLostProduct};  ///< error of min_distance() that does not shrink with it
};

/// Bits of the boxes that may reach into a ball, and min_distance() of their points nearest to its
/// centre.
[[gnu::always_inline]] inline unsigned boxes_near(const SearchBall& ball,
                                                  const BlockBoxes& row,
                                                  float (&distance)[kBlock]) {
  unsigned near = 0;
  for (int i = 0; i < kBlock; i += kWidth<Block>) {
    const auto nearest = [&](int a, const Block& center) {
      return min(max(center, load<Block>(row.side[a] + i)), load<Block>(row.side[3 + a] + i));
    };
    const Block of = ball.min_distance(
        {nearest(0, ball.center.x), nearest(1, ball.center.y), nearest(2, ball.center.z)});
    store(distance + i, of);
    const auto is_box = load<Block>(row.side[0] + i) <= load<Block>(row.side[3] + i);
    near |= bits(and_not(is_box, of > Block(ball.reach))) << i;
  }
  return near;
}

/// How far along `way` three points reach, times its length.
struct ReachAlong {
  Block least, most;
  Block error;

  [[gnu::always_inline]] ReachAlong(const Vec3<Block>& way,
                                    const Vec3<Block> (&corner)[3],
                                    const Block& farthest) {
    const Block x = dot(way, corner[0]);
    const Block y = dot(way, corner[1]);
    const Block z = dot(way, corner[2]);
    const Vec3<Block> s = sizes(way);
    least = min(min(x, y), z);
    most = max(max(x, y), z);
    error = Block(kAlongError) * farthest * (s.x + s.y + s.z) + Block(kLostProduct);
  }
  /// Of all points between them.
  Block surely_at_least() const { return least - error; }
  /// The same, whichever way.
  Block surely_beside() const { return max(least, Block(0) - most) - error; }
};

/// The point of a segment that is nearest to 0, about.
[[gnu::always_inline]] inline Vec3<Block> near_on_segment(const Vec3<Block>& a,
                                                          const Vec3<Block>& b) {
  const Vec3<Block> along = b - a;
  const Block share = (Block(0) - dot(a, along)) / dot(along, along);
  return a + min(max(share, Block(0)), Block(1)) * along;
}

/// Triangles i, i + 1, ... of a block.
struct BlockCorners {
  Vec3<Block> a, b, c;

  [[gnu::always_inline]] BlockCorners(const TriangleBlock& block, int i)
      : a(at(block.a, i)), b(at(block.b, i)), c(at(block.c, i)) {}

 private:
  [[gnu::always_inline]] static Vec3<Block> at(const float (&corner)[3][kBlock], int i) {
    return {load<Block>(corner[0] + i), load<Block>(corner[1] + i), load<Block>(corner[2] + i)};
  }
};

/// Where the boxes of triangles are surely beyond a ball, or all their corners beyond a plane that
/// touches it.
[[gnu::always_inline]] inline Mask<Block> are_beyond(const SearchBall& ball,
                                                     const BlockCorners& t) {
  const auto nearest = [](const Block& x, const Block& a, const Block& b, const Block& c) {
    return min(max(x, min(min(a, b), c)), max(max(a, b), c));
  };
  const Vec3<Block>& p = ball.center;
  const Block distance = ball.min_distance({nearest(p.x, t.a.x, t.b.x, t.c.x),
                                            nearest(p.y, t.a.y, t.b.y, t.c.y),
                                            nearest(p.z, t.a.z, t.b.z, t.c.z)});
  const Vec3<Block> corner[3] = {t.a - p, t.b - p, t.c - p};
  const Vec3<Block> n = cross(corner[1] - corner[0], corner[2] - corner[0]);
  const Block farthest = max(max(largest(corner[0]), largest(corner[1])), largest(corner[2]));
  const Block length = square_root(dot(n, n)) * Block(1 + kLengthError) + Block(kLostLength);
  const Block above = ReachAlong(n, corner, farthest).surely_beside();
  return mask_or(distance > Block(ball.reach), above > Block(ball.radius) * length);
}

/// The same from afar, of SearchBall::min_distance(): it is convex, so the plane that touches it at
/// one corner bounds it.
[[gnu::always_inline]] inline Mask<Block> are_beyond_afar(const SearchBall& ball,
                                                          const BlockCorners& t) {
  const Vec3<Block> slope = ball.slope(t.a);
  const Block most = max(max(dot(slope, t.b - t.a), dot(slope, t.c - t.a)), Block(0));
  return ball.min_distance(t.a) - most > Block(ball.reach);
}

/// Bits of the triangles of a block that may reach into a ball.
[[gnu::always_inline]] inline unsigned triangles_near(const SearchBall& ball,
                                                      const TriangleBlock& block) {
  unsigned near = 0;
  for (int i = 0; i < kBlock; i += kWidth<Block>) {
    const BlockCorners t(block, i);
    const Mask<Block> beyond = ball.is_far() ? are_beyond_afar(ball, t) : are_beyond(ball, t);
    near |= bits(and_not(t.a.x == t.a.x, beyond)) << i;
  }
  return near;
}

/// Bits of the spheres i, i + 1, ... that may reach into a ball.
[[gnu::always_inline]] inline unsigned primitives_near(const SearchBall& ball,
                                                       const FieldArrays<Sphere>& spheres,
                                                       std::uint32_t i) {
  const Vec3<Block> to{load<Block>(spheres.center[0] + i) - ball.center.x,
                       load<Block>(spheres.center[1] + i) - ball.center.y,
                       load<Block>(spheres.center[2] + i) - ball.center.z};
  const Block distance = length(to);
  const Block radius = magnitude(load<Block>(spheres.radius + i));
  const Block error = Block(kLengthError) * (distance + radius) + Block(kLostLength);
  const Block gap = magnitude(distance - radius);
  return bits(gap == gap) & ~bits(gap - error > Block(ball.radius));
}

/// Of cones: in the half plane of the axis and the centre, a side is a segment.
[[gnu::always_inline]] inline unsigned primitives_near(const SearchBall& ball,
                                                       const FieldArrays<Cone>& cones,
                                                       std::uint32_t i) {
  const auto at = [i](const float* field) { return load<Block>(field + i); };
  const Vec3<Block> axis{at(cones.axis[0]), at(cones.axis[1]), at(cones.axis[2])};
  const Vec3<Block> from_base =
      ball.center - Vec3<Block>{at(cones.base[0]), at(cones.base[1]), at(cones.base[2])};
  const Block height = at(cones.height);
  const Block narrow = at(cones.radius);
  const Block wide = narrow + at(cones.slope) * height;
  const Block along = dot(from_base, axis);
  const Block away = length(from_base - along * axis);
  const Block o(0);
  const Vec3<Block> ends[3] = {{o - along, narrow - away, o},
                               {height - along, wide - away, o},
                               {height - along, wide - away, o}};
  const Vec3<Block> near = near_on_segment(ends[0], ends[1]);
  const Block farthest = max(largest(ends[0]), largest(ends[1]));
  const Block near_length = length(near) * Block(1 + kLengthError) + Block(kLostLength);
  const Block error =
      Block(kBesideError) * (length(from_base) + (height + (narrow + wide))) + Block(kLostLength);
  const auto beyond = ReachAlong(near, ends, farthest).surely_at_least() >
                      (Block(ball.radius) + error) * near_length;
  return ~bits(beyond);
}

// The search for the point of a scene that is nearest to another: down levels of boxes, the nearest
// first.

/// Distance in double, and coordinates: error <= kDistanceError * distance (docs/proofs.md).
inline constexpr double kDistanceError = 0x1p-44;

/// Of some boxes of a row, by bits, the one that is nearest.
[[gnu::always_inline]] inline int nearest_of(unsigned boxes, const float (&distance)[kBlock]) {
  int nearest = __builtin_ctz(boxes);
  float least = distance[nearest];
  each_bit(boxes & (boxes - 1), [&](int k) {
    const bool is_less = distance[k] < least;
    least = is_less ? distance[k] : least;
    nearest = is_less ? k : nearest;
  });
  return nearest;
}

/// Boxes that wait to be looked into.
class BoxStack {
 public:
  struct Entry {
    float distance;  ///< see SearchBall
    int level;       ///< of the row that the box stands for; -1: a cell
    std::uint32_t index;
  };

  bool empty() const { return size_ == 0; }
  Entry pop() { return entry_[--size_]; }
  /// Boxes k of a row, `first` + k on the level below, by bits; the nearest is the next.
  void push(unsigned boxes, const float (&distance)[kBlock], int level, std::uint32_t first) {
    if (boxes == 0)
      return;
    const auto put = [&](int k) {
      entry_[size_++] = {distance[k], level, first + static_cast<std::uint32_t>(k)};
    };
    const int nearest = nearest_of(boxes, distance);
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
    float distance[kBlock];
    const auto push = [&](int level, std::uint32_t row) {
      const unsigned near = boxes_near(ball_, g.levels.rows[g.levels.first[level] + row], distance);
      stack.push(near, distance, level - 1, row * kBlock);
    };
    if (g.levels.levels > 0)
      push(g.levels.levels - 1, 0);
    while (!stack.empty()) {
      const BoxStack::Entry box = stack.pop();
      if (box.distance > ball_.reach)
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
      float distance[kBlock];
      unsigned near = boxes_near(ball_, list.boxes[row], distance);
      near &= first > begin ? ~0u << (first - begin) : ~0u;
      near &= end - begin < kBlock ? (1u << (end - begin)) - 1 : ~0u;
      while (near != 0) {
        const int k = nearest_of(near, distance);
        near &= ~(1u << k);
        if (distance[k] > ball_.reach)
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
