// Cones: every instruction set and method against the reference bit for bit; exact numbers
// against long double, floats and doubles against exact numbers.
#include "kernel/shapes/cone.hpp"

#include "grelha/query.hpp"
#include "kernel/shapes/primitives.hpp"
#include "tests/support/one_hit.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

class Cone : public EveryVariant {};
GRELHA_FOR_EVERY_ISA(Cone);

struct Shape {
  Float3 base, apex;
  float r0, r1;
};

/// Cylinders, cones with a tip, frusta, needles and flat collars; one in five shows its inside
/// alone.
Shape random_shape(Random& random, double& size) {
  size = random.log_in(1e-12, 1e12);
  const double height = size * random.log_in(.05, 20);
  Shape s;
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
Shape flat_shape(Random& random, double& size) {
  for (;;) {
    Shape s = random_shape(random, size);
    const double wide = std::max(std::abs(s.r0), std::abs(s.r1));
    s.apex = at(s.base, wide * random.log_in(1e-18, .05), random.direction());
    size = wide;
    if (s.apex.x != s.base.x || s.apex.y != s.base.y || s.apex.z != s.base.z)
      return s;
  }
}

TEST_P(Cone, ReturnsTheScalarBits) {
  std::size_t hits = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    double size;
    const Shape c = seed % 3 == 2 ? flat_shape(random, size) : random_shape(random, size);
    const Scene scene = one_cone(c.base, c.r0, c.apex, c.r1);
    const World world(scene, {.grid = false});
    const RayList rays =
        with_odd_values(random, rays_about(random, c.base, size, kManyRays), seed % 2 ? .1 : 0);
    const Truth truth = truth_of(scene, rays);
    expect_truth(variant(), world, rays, truth, "seed " + std::to_string(seed));
    hits += hits_of(truth.closest);
  }
  EXPECT_GT(hits, 60u * kManyRays / 12);
}

OneHit hit(const Float3& o, const Float3& d, const Shape& s, float t_min = 0) {
  Geometry g;
  g.cones.add(s.base, s.r0, s.apex, s.r1, 0);
  return one_hit<grelha::Cone>(exact_ray(o, d, t_min), grelha::Cone::Source(g)[0]);
}

struct Case {
  Shape shape;
  Float3 org, dir;
  oracle::Real unit;  ///< eps (|org - base| + height + radius): what the header counts in
};

/// What a ray is aimed at. Near a tip the quadratic's roots meet, and its coefficients may be large
/// beside what lies between them.
enum class Target { kSide, kNarrowEnd, kAlongTheSide, kFlat };

/// A point of the wider end's rim, on the side where `out` points.
Float3 rim_point(const oracle::V& narrow,
                 const oracle::V& wide,
                 oracle::Real radius,
                 const Float3& out) {
  const oracle::V axis = oracle::unit(wide - narrow),
                  across = oracle::V(out) - dot(axis, oracle::V(out)) * axis;
  const oracle::V p = wide + radius * oracle::unit(across);
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// One draw a statement: which of a call's arguments is evaluated first is up to the compiler.
Case random_case(std::uint64_t seed, double farthest, Target aim) {
  Random random(seed);
  double size;
  Case k;
  k.shape = aim == Target::kFlat ? flat_shape(random, size) : random_shape(random, size);
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

class ConePoints : public testing::TestWithParam<Target> {};

TEST_P(ConePoints, LieOnTheSurface) {
  oracle::Real worst = 0;
  int hits = 0, over = 0;
  for (std::uint64_t seed = 0; seed < 300000; ++seed) {
    const Case k = random_case(seed, 1e4, GetParam());
    const auto [found, t] = hit(k.org, k.dir, k.shape);
    if (!found)
      continue;
    ++hits;
    const oracle::Frustum f{k.shape.base, k.shape.apex, k.shape.r0, k.shape.r1};
    const oracle::Real error = f.distance(oracle::Ray{k.org, k.dir}.point(t)) / k.unit;
    if (!(error <= 32) && ++over <= 3)
      ADD_FAILURE() << "seed " << seed << ": " << static_cast<double>(error) << " units off";
    worst = std::max(worst, error);
  }
  std::printf("cone: %d hits, %d over, worst %.2f eps (|o - base| + h + r)\n",
              hits,
              over,
              static_cast<double>(worst));
  EXPECT_EQ(over, 0);
  EXPECT_GT(hits, 60000);
}

INSTANTIATE_TEST_SUITE_P(
    Aims,
    ConePoints,
    testing::Values(Target::kSide, Target::kNarrowEnd, Target::kAlongTheSide, Target::kFlat),
    [](const auto& aim) {
      return aim.param == Target::kSide        ? "Side"
             : aim.param == Target::kFlat      ? "Flat"
             : aim.param == Target::kNarrowEnd ? "NarrowEnd"
                                               : "AlongTheSide";
    });

/// What a ray surely hits: it, and each of six moved by twice the bound, crosses the surface, and
/// not within the bound of an end. A hole narrower than the bound may be passed or not.
TEST(ConeOracle, LosesNoHitNearATip) {
  int wanted = 0, lost = 0;
  for (std::uint64_t seed = 0; seed < 300000; ++seed) {
    const Case k = random_case(seed, 1e3, seed % 2 ? Target::kNarrowEnd : Target::kAlongTheSide);
    const oracle::Frustum f{k.shape.base, k.shape.apex, k.shape.r0, k.shape.r1};
    const oracle::Real bound = 32 * k.unit, hole = std::min(std::abs(f.r0), std::abs(f.r1));
    if (hole > 0 && hole < bound)
      continue;
    const auto sure = [&](const oracle::Ray& ray) {
      const auto crossing = f.first(ray, 0);
      if (!crossing)
        return false;
      const oracle::Real z = f.height_at(ray.point(crossing->t));
      return z > bound && z < f.height() - bound;
    };
    const oracle::Ray ray{k.org, k.dir};
    bool all = sure(ray);
    for (int i = 0; i < 6 && all; ++i) {
      oracle::Ray moved = ray;
      (i / 2 == 0   ? moved.org.x
       : i / 2 == 1 ? moved.org.y
                    : moved.org.z) += 2 * bound * (i % 2 ? 1 : -1);
      all = sure(moved);
    }
    if (!all)
      continue;
    ++wanted;
    lost += !hit(k.org, k.dir, k.shape).hit;
  }
  std::printf("cone: %d surely met, %d lost\n", wanted, lost);
  EXPECT_EQ(lost, 0);
  EXPECT_GT(wanted, 40000);
}

/// A ray that crosses the side steeply and far from the rims must hit at the same crossing as the
/// oracle; a ray that is far from the side must miss.
TEST(ConeOracle, FindsTheFirstCrossing) {
  int judged = 0, wrong = 0;
  oracle::Real worst = 0;
  for (std::uint64_t seed = 0; seed < 300000; ++seed) {
    const Case k = random_case(seed, 1e3, Target::kSide);
    const oracle::Frustum f{k.shape.base, k.shape.apex, k.shape.r0, k.shape.r1};
    const oracle::Ray ray{k.org, k.dir};
    const oracle::Real tolerance = 32 * k.unit;
    const auto wanted = f.first(ray, 0);
    if (!wanted || f.distance(ray.org) <= tolerance)
      continue;
    const oracle::V p = ray.point(wanted->t);
    const oracle::Real z = f.height_at(p), rho = length(cross(f.axis(), p - f.base));
    // Off by `tolerance` across the surface is tolerance / cosine along the ray; that must stay
    // small against what bends.
    const oracle::Real along = tolerance / wanted->cosine;
    if (wanted->cosine < .05L || 20 * along > rho || z < along || z > f.height() - along)
      continue;
    ++judged;
    const auto [found, t] = hit(k.org, k.dir, k.shape);
    if (found && t < wanted->t && f.distance(ray.point(t)) <= tolerance)
      continue;  // hit the other rim, which is as near as none
    const oracle::Real error =
        found ? std::abs(t - wanted->t) * length(ray.dir) / along * 32 : 1e9L;
    worst = std::max(worst, error);
    if (!(error <= 2 * 32) && ++wrong <= 3)
      ADD_FAILURE() << "seed " << seed << ": found " << found << " t " << t << " against "
                    << static_cast<double>(wanted->t);
  }
  std::printf("cone: %d judged, worst along the ray %.2f units / cosine\n",
              judged,
              static_cast<double>(worst));
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(judged, 40000);
}

/// The shading point lies on the surface, within a quarter of the offset of new rays, and at the
/// point that the ray hit: its height is off by up to 32 units, its radius by kSteep times that.
TEST(ConeOracle, IsShadedWhereItIs) {
  int judged = 0, off = 0, aside = 0;
  for (std::uint64_t seed = 0; seed < 40000; ++seed) {
    const Case k = random_case(seed, 1e3, seed % 2 ? Target::kFlat : Target::kSide);
    const Scene scene = one_cone(k.shape.base, k.shape.r0, k.shape.apex, k.shape.r1);
    const World world(scene, {.grid = false, .threads = 1});
    const Ray ray{.org = k.org, .dir = k.dir};
    const grelha::Hit met = closest(world, ray);
    if (!met)
      continue;
    const SurfacePoint at = surface(world, ray, met);
    const oracle::Frustum f{k.shape.base, k.shape.apex, k.shape.r0, k.shape.r1};
    ++judged;
    const oracle::Real bound =
        oracle::kEps * (8 * (f.height() + std::max(std::abs(f.r0), std::abs(f.r1))) +
                        4 * length(oracle::V(at.point)));
    off += !(f.distance(oracle::V(at.point)) <= bound);
    aside +=
        !(length(oracle::V(at.point) - oracle::Ray{k.org, k.dir}.point(met.t)) <= 256 * k.unit);
  }
  std::printf("cone: %d shaded, %d off, %d elsewhere\n", judged, off, aside);
  EXPECT_EQ(off, 0);
  EXPECT_EQ(aside, 0);
  EXPECT_GT(judged, 8000);
}

/// Flat cones are hit between their rims, and not beside: as flat as can be, the ray crosses their
/// plane where its distance from the axis says so by more than the bound.
TEST(ConeOracle, MeetsFlatOnesBetweenTheirRims) {
  int between = 0, lost = 0, beside = 0, met = 0;
  for (std::uint64_t seed = 0; seed < 300000; ++seed) {
    const Case k = random_case(seed, 1e3, Target::kFlat);
    const oracle::Frustum f{k.shape.base, k.shape.apex, k.shape.r0, k.shape.r1};
    if (k.shape.r0 + k.shape.r1 <= 0 || k.shape.r0 == k.shape.r1)
      continue;
    const oracle::V org = oracle::V(k.org), dir = oracle::V(k.dir);
    const oracle::Real along = dot(dir, f.axis()) / length(dir);
    const oracle::Real t = dot(f.base - org, f.axis()) / dot(dir, f.axis());
    const oracle::Real slack = (32 * k.unit + f.height()) / std::abs(along);
    const oracle::V p = org + t * dir;
    const oracle::Real rho = length(cross(f.axis(), p - f.base));
    if (std::abs(along) < .05L || t * length(dir) < slack)
      continue;
    const oracle::Real least = std::min(f.r0, f.r1), most = std::max(f.r0, f.r1);
    const bool hits = hit(k.org, k.dir, k.shape).hit;
    const bool inside = rho > least + slack && rho < most - slack;
    const bool outside = rho < least - slack || rho > most + slack;
    between += inside;
    lost += inside && !hits;
    beside += outside;
    met += outside && hits;
  }
  std::printf("cone: %d flat ones met, %d lost; %d passed, %d met\n", between, lost, beside, met);
  EXPECT_EQ(lost, 0);
  EXPECT_EQ(met, 0);
  EXPECT_GT(between, 40000);
  EXPECT_GT(beside, 40000);
}

/// Traces rays that start above the side by a quarter of the offset of new rays (`away` in
/// surface.hpp) and go outwards: nearly along the side, or nearly along a line of the cone. The
/// cone is convex, so no ray may hit it.
TEST(ConeOracle, IsNotMetByWhatLeavesIt) {
  int left = 0, met = 0;
  for (std::uint64_t seed = 0; seed < 600000; ++seed) {
    Random random(seed);
    double size;
    const Shape shape = random.chance(.3) ? flat_shape(random, size) : random_shape(random, size);
    if (shape.r0 + shape.r1 <= 0)
      continue;  // no radius, or only the inside
    const oracle::Frustum f{shape.base, shape.apex, shape.r0, shape.r1};
    const oracle::Real slope = (f.r1 - f.r0) / f.height(), z = f.height() * random.unit();
    const oracle::V out = oracle::V(random.direction()),
                    across = oracle::unit(out - dot(out, f.axis()) * f.axis());
    const oracle::V normal = oracle::unit(across - slope * f.axis()),
                    line = oracle::unit(f.axis() + slope * across);
    const oracle::V p = f.base + z * f.axis() + (f.r0 + slope * z) * across;
    const oracle::Real bound =
        oracle::kEps * (8 * (f.height() + std::max(f.r0, f.r1)) + 4 * length(p));
    const auto rounded = [](const oracle::V& v) {
      return Float3{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
    };
    oracle::V way = random.direction();
    if (random.chance(.5)) {
      const double sign = random.sign(), apart = random.log_in(1e-6, 1);
      way = static_cast<oracle::Real>(sign) * line + static_cast<oracle::Real>(apart) * way;
    }
    way = way - dot(way, normal) * normal +
          static_cast<oracle::Real>(random.log_in(1e-6, .1)) * normal;
    const Float3 dir = rounded(way);
    if (dot(oracle::V(dir), normal) < 8 * oracle::kEps * length(way))
      continue;
    ++left;
    met += hit(rounded(p + bound * normal), dir, shape).hit;
  }
  std::printf("cone: %d rays leave, %d meet it again\n", left, met);
  EXPECT_EQ(met, 0);
  EXPECT_GT(left, 300000);
}

TEST(ConeCorners, EndsSidesAndAxes) {
  const Shape pipe{{0, 0, 0}, {0, 2, 0}, 1, 1}, lining{{0, 0, 0}, {0, 2, 0}, -1, -1},
      tip{{0, 0, 0}, {0, 2, 0}, 1, 0};
  EXPECT_EQ(hit({3, 1, 0}, {-1, 0, 0}, pipe).t, 2);
  EXPECT_EQ(hit({3, 1, 0}, {-1, 0, 0}, lining).t, 4);
  EXPECT_EQ(hit({0, 1, 0}, {-.5f, 0, 0}, pipe).t, 2);
  EXPECT_FALSE(hit({3, 2.01f, 0}, {-1, 0, 0}, pipe).hit);  // past the rim
  EXPECT_FALSE(hit({3, -.01f, 0}, {-1, 0, 0}, pipe).hit);
  EXPECT_FALSE(hit({0, 5, 0}, {0, -1, 0}, pipe).hit);  // down the middle: no caps
  EXPECT_TRUE(hit({.5f, 4, 0}, {0, -1, 0}, tip).hit);
  EXPECT_EQ(hit({.5f, 4, 0}, {0, -1, 0}, tip).t, 3);
  EXPECT_FALSE(hit({-1.5f, 4, 0}, {0, -1, 0}, tip).hit);
  // and not the mirrored cone above the tip
  EXPECT_EQ(hit({.25f, 5, 0}, {0, -1, 0}, tip).t, 3.5f);
  // the interval is open: t .75 itself does not count
  EXPECT_EQ(hit({1.5f, .5f, 0}, {-1, 0, 0}, tip, .75f).t, 2.25f);
}

}  // namespace
}  // namespace grelha::test
