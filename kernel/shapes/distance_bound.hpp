#pragma once
// Which primitives and boxes may be within a distance of a point, as floats tell: a block at a
// time. They bound; doubles decide. docs/numerics.md ("Closest points") derives the bounds.

#include "kernel/base/vec3.hpp"
#include "kernel/shapes/cone_fields.hpp"
#include "kernel/shapes/simd_fields.hpp"
#include "kernel/shapes/sphere.hpp"
#include "kernel/shapes/triangle.hpp"

namespace grelha::GRELHA_ISA {

/// Times the magnitudes of its terms: error of a product of vectors, 5 u.
inline constexpr float kAlongError = 8 * kEps;
/// Times a length: its error, 4 u of its square.
inline constexpr float kLengthError = 8 * kEps;
/// Times the size of what is seen from afar: error of SearchBall::beside(), 50 u.
inline constexpr float kBesideLost = 64 * kEps;
/// Times the farthest of three points: error of one between them, 12 u.
inline constexpr float kFootError = 32 * kEps;
/// Times a cone and the way to it: error of where a point lies beside its axis, 15 u.
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
  float reach = 0;   ///< of boxes that the ball reaches, beside() is no more

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
    lost_ = double{kBesideLost} * (2 * size + size * size * unit_);
    from_ = {Block(from[0]), Block(from[1]), Block(from[2])};
    const auto twice = [&](double x) { return Block(static_cast<float>(2 * x * unit_)); };
    twice_ = {twice(way[0]), twice(way[1]), twice(way[2])};
  }
  void shrink(double r) {
    const double beside = (r - away_) * (r + away_) * unit_;
    reach = round_up(beside + 8 * double{kEps} * magnitude(beside) + lost_);
    radius = round_up(r);
  }
  bool is_far() const { return away_ > 0; }
  /// Of points x: a number that grows with the distance.
  [[gnu::always_inline]] Block beside(const Vec3<Block>& x) const {
    const Vec3<Block> e = from_ - x;
    return dot(e, twice_ + Block(static_cast<float>(unit_)) * e);
  }
  /// How fast beside() shrinks along each axis.
  [[gnu::always_inline]] Vec3<Block> slope(const Vec3<Block>& x) const {
    return twice_ + Block(static_cast<float>(2 * unit_)) * (from_ - x);
  }
  /// No less than the distance of a point that lies so much beside, as floats tell.
  double distance_of(float beside) const {
    return square_root(away_ * away_ + (static_cast<double>(beside) + lost_) * away_);
  }

 private:
  Vec3<Block> from_, twice_{Block(0), Block(0), Block(0)};
  double away_ = 0, unit_ = 1;
  double lost_ = double{kLostProduct};  ///< error of beside() that does not shrink with it
};

/// Bits of the boxes that may reach into a ball, and beside() of their points nearest to its
/// centre.
[[gnu::always_inline]] inline unsigned boxes_near(const SearchBall& ball,
                                                  const BlockBoxes& row,
                                                  float (&beside)[kBlock]) {
  unsigned near = 0;
  for (int i = 0; i < kBlock; i += kWidth<Block>) {
    const auto nearest = [&](int a, const Block& center) {
      return min(max(center, load<Block>(row.side[a] + i)), load<Block>(row.side[3 + a] + i));
    };
    const Block of = ball.beside(
        {nearest(0, ball.center.x), nearest(1, ball.center.y), nearest(2, ball.center.z)});
    store(beside + i, of);
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

/// Bounds of the distances of triangles side by side.
struct TriangleBounds {
  Block lower;  ///< 0 or less: nothing is known
  Block upper;
};

/// Of triangles i, i + 1, ... of a block. The point of a triangle that is about nearest bounds the
/// distance from above. From below, it is bounded by the plane through that point and across the
/// way to it: all corners lie behind.
[[gnu::always_inline]] inline TriangleBounds triangle_bounds(const Vec3<Block>& p,
                                                             const TriangleBlock& block,
                                                             int i) {
  const auto corner_of = [&](const float (&corner)[3][kBlock]) {
    return Vec3<Block>{load<Block>(corner[0] + i),
                       load<Block>(corner[1] + i),
                       load<Block>(corner[2] + i)} -
           p;
  };
  const Vec3<Block> corner[3] = {corner_of(block.a), corner_of(block.b), corner_of(block.c)};
  const auto& [a, b, c] = corner;
  const Vec3<Block> n = cross(b - a, c - a);
  const Block nn = dot(n, n);
  const Block of_a = dot(cross(b, c), n);
  const Block of_b = dot(cross(c, a), n);
  const Block of_c = (nn - of_a) - of_b;
  const Block share = Block(1) / ((of_a + of_b) + of_c);
  const Vec3<Block> foot = share * (of_a * a + of_b * b + of_c * c);
  Vec3<Block> way = near_on_segment(a, b);
  Block squared = dot(way, way);
  const auto compare = [&](const Vec3<Block>& other) {
    const Block of_other = dot(other, other);
    const auto is_less = of_other < squared;
    way = select(is_less, other, way);
    squared = select(is_less, of_other, squared);
  };
  compare(near_on_segment(b, c));
  compare(near_on_segment(c, a));
  const Block of_foot = dot(foot, foot);
  const auto is_foot =
      mask_and(min(min(of_a, of_b), of_c) >= Block(0), of_foot <= squared);
  const Block least = select(is_foot, of_foot, squared);
  way = select(is_foot, n, way);
  squared = select(is_foot, nn, squared);
  const Block farthest = max(max(largest(a), largest(b)), largest(c));
  const Block known(1 + kLengthError), lost(kLostLength);
  return {ReachAlong(way, corner, farthest).surely_beside() / (square_root(squared) * known + lost),
          square_root(least) * known + (Block(kFootError) * farthest + lost)};
}

/// The same from afar, of SearchBall::beside(), which is convex: one corner bounds it from above,
/// and the plane that touches it there from below.
[[gnu::always_inline]] inline TriangleBounds triangle_bounds_from_afar(const SearchBall& ball,
                                                                       const TriangleBlock& block,
                                                                       int i) {
  const auto corner_of = [&](const float (&corner)[3][kBlock]) {
    return Vec3<Block>{
        load<Block>(corner[0] + i), load<Block>(corner[1] + i), load<Block>(corner[2] + i)};
  };
  const Vec3<Block> a = corner_of(block.a), b = corner_of(block.b), c = corner_of(block.c);
  const Block of_a = ball.beside(a);
  const Vec3<Block> slope = ball.slope(a);
  const Block most = max(max(dot(slope, b - a), dot(slope, c - a)), Block(0));
  return {of_a - most, min(of_a, min(ball.beside(b), ball.beside(c)))};
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
  const Block beside = magnitude(distance - radius);
  return bits(beside == beside) & ~bits(beside - error > Block(ball.radius));
}

/// Of cones: in the half plane of the axis and the centre, a side is a segment.
[[gnu::always_inline]] inline unsigned primitives_near(const SearchBall& ball,
                                                       const FieldArrays<Cone>& cones,
                                                       std::uint32_t i) {
  const auto at = [i](const float* field) { return load<Block>(field + i); };
  const Vec3<Block> axis{at(cones.axis[0]), at(cones.axis[1]), at(cones.axis[2])};
  const Vec3<Block> from_base = ball.center - Vec3<Block>{at(cones.base[0]),
                                                          at(cones.base[1]),
                                                          at(cones.base[2])};
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
  const Block error = Block(kBesideError) * (length(from_base) + (height + (narrow + wide))) +
                      Block(kLostLength);
  const auto beyond =
      ReachAlong(near, ends, farthest).surely_at_least() > (Block(ball.radius) + error) * near_length;
  return ~bits(beyond);
}

}  // namespace grelha::GRELHA_ISA
