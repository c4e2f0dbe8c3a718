#pragma once
// Cones and rays aimed at them, for cone_test.cpp.

#include "tests/support/oracle.hpp"
#include "tests/support/rays.hpp"

namespace grelha::test {

struct ConeShape {
  Float3 base, apex;
  float r0, r1;
};

/// Cylinders, cones with a tip, frusta, needles and flat collars; one in five shows its inside
/// alone.
inline ConeShape random_cone(Random& random, double& size) {
  size = random.log_in(1e-12, 1e12);
  const double height = size * random.log_in(.05, 20);
  ConeShape s;
  s.base = random.chance(.3) ? Float3{} : random.point(size * random.log_in(1e-2, 1e2));
  const Float3 axis =
      random.chance(.3) ? Float3{0, random.chance(.5) ? 1.f : -1.f, 0} : random.direction();
  s.apex = at(s.base, height, axis);
  const double sign = random.chance(.2) ? -1 : 1;
  s.r0 = static_cast<float>(sign * size * random.in(.05, 1));
  s.r1 = random.chance(.3)   ? s.r0
         : random.chance(.2) ? 0.f
                             : static_cast<float>(sign * size * random.in(.05, 1));
  if (random.chance(.2))
    std::swap(s.r0, s.r1);
  size = std::max(size, height);
  return s;
}

/// The same down to washers 1e-18 times as high as wide: most of these have no height left unless
/// they lie at the origin.
inline ConeShape flat_cone(Random& random, double& size) {
  for (;;) {
    ConeShape s = random_cone(random, size);
    const double wide = std::max(std::abs(s.r0), std::abs(s.r1));
    s.apex = at(s.base, wide * random.log_in(1e-18, .05), random.direction());
    size = wide;
    if (s.apex.x != s.base.x || s.apex.y != s.base.y || s.apex.z != s.base.z)
      return s;
  }
}

struct ConeCase {
  ConeShape shape;
  Float3 org, dir;
  oracle::Real unit;  ///< eps (|org - base| + height + radius): what the header counts in
};

/// What a ray is aimed at. Near a tip the quadratic's roots meet, and its coefficients may be large
/// beside what lies between them.
enum class Target { kSide, kNarrowEnd, kAlongTheSide, kFlat };

/// A point of the wider end's rim, on the side where `out` points.
inline Float3 rim_point(const oracle::V& narrow,
                        const oracle::V& wide,
                        oracle::Real radius,
                        const Float3& out) {
  const oracle::V axis = oracle::unit(wide - narrow),
                  across = oracle::V(out) - dot(axis, oracle::V(out)) * axis;
  const oracle::V p = wide + radius * oracle::unit(across);
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// One draw a statement: which of a call's arguments is evaluated first is up to the compiler.
inline ConeCase random_case(std::uint64_t seed, double farthest, Target aim) {
  Random random(seed);
  double size;
  ConeCase k;
  k.shape = aim == Target::kFlat ? flat_cone(random, size) : random_cone(random, size);
  if (aim == Target::kNarrowEnd ||
      aim ==
          Target::kAlongTheSide) {  // half with a tip, the others down to nearly one, at either end
    const double share = random.log_in(1e-7, 1);
    if (k.shape.r0 == 0)
      k.shape.r0 = k.shape.r1;
    k.shape.r1 = random.chance(.5) ? 0.f : static_cast<float>(k.shape.r0 * share);
    if (random.chance(.5))
      std::swap(k.shape.r0, k.shape.r1);
  }
  const oracle::Frustum f{k.shape.base, k.shape.apex, k.shape.r0, k.shape.r1};
  const bool base_is_wide = std::abs(k.shape.r0) > std::abs(k.shape.r1);
  const Float3 narrow = base_is_wide ? k.shape.apex : k.shape.base,
               wide = base_is_wide ? k.shape.base : k.shape.apex;
  const double distance = random.chance(.2) ? random.unit() : random.log_in(.5, farthest);
  const Float3 side = random.direction(), across = random.direction();
  k.org = at(k.shape.base, size * distance, side);
  Float3 target;
  if (aim == Target::kSide || aim == Target::kFlat) {
    const double height = random.unit(), beside = random.in(0, aim == Target::kFlat ? 1.2 : .5);
    target = at(at(k.shape.base, height, minus(k.shape.apex, k.shape.base)), size * beside, across);
  } else {
    const double beside = random.log_in(1e-9, 1);
    target = at(narrow, size * beside, across);
  }
  if (aim == Target::kAlongTheSide) {
    const Float3 rim = rim_point(
        narrow, wide, std::max(std::abs(k.shape.r0), std::abs(k.shape.r1)), random.direction());
    const double sign = random.sign(), lengths = sign * random.log_in(.5, 1e2),
                 beside = random.log_in(1e-9, .1);
    k.org = at(at(narrow, lengths, minus(rim, narrow)), size * beside, side);
  }
  k.dir = scaled(minus(target, k.org), random.log_in(1e-2, 1e2));
  k.unit = oracle::kEps * (length(oracle::V(k.org) - f.base) + f.height() +
                           std::max(std::abs(f.r0), std::abs(f.r1)));
  return k;
}

}  // namespace grelha::test
