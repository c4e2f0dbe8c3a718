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
/// Times a cone and the way to it: error of where a point lies beside its axis, 15 u.
inline constexpr float kBesideError = 32 * kEps;
/// More than what underflows in a product, and in a length.
inline constexpr float kLostProduct = 0x1p-140f;
inline constexpr float kLostLength = 0x1p-70f;

/// A point and how far from it others matter, for each lane.
struct SearchBall {
  Vec3<Block> center;
  Block radius;   ///< of no primitive found so far, infinity
  float reach;    ///< not below the square of the radius, nor what floats make of smaller ones
  Block squared;  ///< the same

  SearchBall(const float (&p)[3], double r) : center{Block(p[0]), Block(p[1]), Block(p[2])} {
    shrink(r);
  }
  void shrink(double r) {
    reach = round_up(r * r * (1 + 8 * double{kEps}) + double{kLostProduct});
    radius = Block(round_up(r));
    squared = Block(reach);
  }
};

/// Bits of the boxes that may reach into a ball, and the squares of their distances.
[[gnu::always_inline]] inline unsigned boxes_near(const SearchBall& ball,
                                                  const BlockBoxes& row,
                                                  float (&squared)[kBlock]) {
  unsigned near = 0;
  for (int i = 0; i < kBlock; i += kWidth<Block>) {
    const auto beside = [&](int a, const Block& center) {
      const Block lo = load<Block>(row.side[a] + i);
      const Block hi = load<Block>(row.side[3 + a] + i);
      return max(max(lo - center, center - hi), Block(0));
    };
    const Vec3<Block> way{
        beside(0, ball.center.x), beside(1, ball.center.y), beside(2, ball.center.z)};
    const Block distance = dot(way, way);
    store(squared + i, distance);
    const auto is_box = load<Block>(row.side[0] + i) <= load<Block>(row.side[3] + i);
    near |= bits(and_not(is_box, distance > ball.squared)) << i;
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

/// Lanes that are surely beyond the ball, whose points are at least `along` / |way| away.
[[gnu::always_inline]] inline Mask<Block> is_beyond(const SearchBall& ball,
                                                    const Block& along,
                                                    const Block& squared) {
  const Block length =
      square_root(squared) * Block(1 + kLengthError) + Block(kLostLength);
  return along > ball.radius * length;
}

/// The point of a segment that is nearest to 0, about.
[[gnu::always_inline]] inline Vec3<Block> near_on_segment(const Vec3<Block>& a,
                                                          const Vec3<Block>& b) {
  const Vec3<Block> along = b - a;
  const Block share = (Block(0) - dot(a, along)) / dot(along, along);
  return a + min(max(share, Block(0)), Block(1)) * along;
}

/// Bits of the triangles of a block that may reach into a ball. Seen from the centre, a triangle
/// lies behind the plane through the point of an edge that is nearest, and behind its own.
[[gnu::always_inline]] inline unsigned triangles_near(const SearchBall& ball,
                                                      const TriangleBlock& block,
                                                      int i) {
  const auto corner_of = [&](const float (&corner)[3][kBlock]) {
    return Vec3<Block>{load<Block>(corner[0] + i) - ball.center.x,
                       load<Block>(corner[1] + i) - ball.center.y,
                       load<Block>(corner[2] + i) - ball.center.z};
  };
  const Vec3<Block> corner[3] = {corner_of(block.a), corner_of(block.b), corner_of(block.c)};
  const auto& [a, b, c] = corner;
  const Block farthest = max(max(largest(a), largest(b)), largest(c));
  const Vec3<Block> n = cross(b - a, c - a);
  const Block above = ReachAlong(n, corner, farthest).surely_beside();
  Vec3<Block> best = near_on_segment(a, b);
  Block squared = dot(best, best);
  const auto compare = [&](const Vec3<Block>& other) {
    const Block of_other = dot(other, other);
    const auto is_less = of_other < squared;
    best = select(is_less, other, best);
    squared = select(is_less, of_other, squared);
  };
  compare(near_on_segment(b, c));
  compare(near_on_segment(c, a));
  const auto beyond = mask_or(is_beyond(ball, above, dot(n, n)),
                              is_beyond(ball, ReachAlong(best, corner, farthest).surely_at_least(), squared));
  return bits(and_not(a.x == a.x, beyond));
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
  return bits(beside == beside) & ~bits(beside - error > ball.radius);
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
      ReachAlong(near, ends, farthest).surely_at_least() > (ball.radius + error) * near_length;
  return ~bits(beyond);
}

}  // namespace grelha::GRELHA_ISA
