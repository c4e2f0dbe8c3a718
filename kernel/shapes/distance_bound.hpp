#pragma once
// Which primitives and boxes may be within a distance of a point, as floats tell: a block at a
// time. They bound; doubles decide. docs/numerics.md ("Closest points") derives the bounds.

#include "kernel/base/vec3.hpp"
#include "kernel/shapes/cone.hpp"
#include "kernel/shapes/arrays.hpp"
#include "kernel/shapes/sphere.hpp"
#include "kernel/shapes/triangle.hpp"

namespace grelha::GRELHA_ISA {

/// Times the magnitudes of its terms: error of a product of vectors, 5 u.
inline constexpr float kAlongError = 8 * kEps;
/// Times a length: its error, 4 u of its square.
inline constexpr float kLengthError = 8 * kEps;
/// Times the size of what is seen from afar: error of SearchBall::beside(), 50 u.
inline constexpr float kBesideLost = 64 * kEps;
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
    reach = static_cast<float>(beside + 16 * double{kEps} * magnitude(beside) + lost_);
    radius = static_cast<float>(r * (1 + 4 * double{kEps}) + double{kLostLength});
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
  const Block beside = ball.beside({nearest(p.x, t.a.x, t.b.x, t.c.x),
                                    nearest(p.y, t.a.y, t.b.y, t.c.y),
                                    nearest(p.z, t.a.z, t.b.z, t.c.z)});
  const Vec3<Block> corner[3] = {t.a - p, t.b - p, t.c - p};
  const Vec3<Block> n = cross(corner[1] - corner[0], corner[2] - corner[0]);
  const Block farthest = max(max(largest(corner[0]), largest(corner[1])), largest(corner[2]));
  const Block length = square_root(dot(n, n)) * Block(1 + kLengthError) + Block(kLostLength);
  const Block above = ReachAlong(n, corner, farthest).surely_beside();
  return mask_or(beside > Block(ball.reach), above > Block(ball.radius) * length);
}

/// The same from afar, of SearchBall::beside(): it is convex, so the plane that touches it at one
/// corner bounds it.
[[gnu::always_inline]] inline Mask<Block> are_beyond_afar(const SearchBall& ball,
                                                          const BlockCorners& t) {
  const Vec3<Block> slope = ball.slope(t.a);
  const Block most = max(max(dot(slope, t.b - t.a), dot(slope, t.c - t.a)), Block(0));
  return ball.beside(t.a) - most > Block(ball.reach);
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
  const Block beside = magnitude(distance - radius);
  return bits(beside == beside) & ~bits(beside - error > Block(ball.radius));
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

}  // namespace grelha::GRELHA_ISA
