// Cones: every instruction set and method against the reference bit for bit; exact numbers
// against long double, floats and doubles against exact numbers.
#include "kernel/shapes/cone.hpp"

#include "grelha/query.hpp"
#include "kernel/shapes/primitives.hpp"
#include "tests/support/cone_cases.hpp"
#include "tests/support/one_hit.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

class Cone : public EveryVariant {};
GRELHA_FOR_EVERY_ISA(Cone);

TEST_P(Cone, ReturnsTheScalarBits) {
  std::size_t hits = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    double size;
    const ConeShape c = seed % 3 == 2 ? flat_cone(random, size) : random_cone(random, size);
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

OneHit hit(const Float3& o, const Float3& d, const ConeShape& s, float t_min = 0) {
  Geometry g;
  g.cones.add(s.base, s.r0, s.apex, s.r1, 0);
  return one_hit<grelha::Cone>(exact_ray(o, d, t_min), grelha::Cone::Source(g)[0]);
}

class ConePoints : public testing::TestWithParam<Target> {};

TEST_P(ConePoints, LieOnTheSurface) {
  oracle::Real worst = 0;
  int hits = 0, over = 0;
  for (std::uint64_t seed = 0; seed < 300000; ++seed) {
    const ConeCase k = random_case(seed, 1e4, GetParam());
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
    const ConeCase k =
        random_case(seed, 1e3, seed % 2 ? Target::kNarrowEnd : Target::kAlongTheSide);
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
    const ConeCase k = random_case(seed, 1e3, Target::kSide);
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
    const ConeCase k = random_case(seed, 1e3, seed % 2 ? Target::kFlat : Target::kSide);
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
    const ConeCase k = random_case(seed, 1e3, Target::kFlat);
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
    const ConeShape shape = random.chance(.3) ? flat_cone(random, size) : random_cone(random, size);
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

/// Floats keep a crossing however closely a search is drawn around it: of rays to the rims and the
/// widest places of a side, from anywhere or nearly along the axis.
TEST(ConeOracle, KeepsCrossingsAtTheEndsOfSearches) {
  int crossed = 0;
  for (std::uint64_t seed = 0; seed < 300000; ++seed) {
    Random random(seed);
    double size;
    const ConeShape shape = random.chance(.2) ? flat_cone(random, size) : random_cone(random, size);
    const bool to_apex = random.chance(.5);
    const Float3 from = to_apex ? shape.apex : shape.base;
    const Float3 to = to_apex ? shape.base : shape.apex;
    const oracle::V rim =
        oracle::V(rim_point(from, to, std::abs(to_apex ? shape.r0 : shape.r1), random.direction()));
    const Float3 target =
        at({static_cast<float>(rim.x), static_cast<float>(rim.y), static_cast<float>(rim.z)},
           random.chance(.5) ? 0 : random.log_in(1e-9, .1),
           minus(from, to));
    Float3 way = random.direction();
    if (random.chance(.5))
      way = at(scaled(minus(to, from), 1 / size), random.log_in(1e-8, 1), way);
    const double distance = size * random.log_in(.5, 1e5);
    const Float3 org = at(target, random.sign() * distance, way);
    const Float3 dir = scaled(minus(target, org), random.log_in(.5, 1e2) / distance);
    Geometry g;
    g.cones.add(shape.base, shape.r0, shape.apex, shape.r1, 0);
    const auto cone = grelha::Cone::Source(g)[0];
    ExactRay ray = exact_ray(org, dir);
    const ExactCrossing crossing = exact_hit(ray, cone);
    const float t = crossing.some() ? crossing.rounded() : 0;
    constexpr float kEnd = std::numeric_limits<float>::infinity();
    if (!(t > 0) || t == kEnd)
      continue;
    ++crossed;
    ray.t_min = std::nextafter(t, -kEnd);
    one_hit<grelha::Cone>(ray, cone, std::nextafter(t, kEnd));
  }
  std::printf("cone: %d crossings at the ends of searches\n", crossed);
  EXPECT_GT(crossed, 60000);
}

TEST(ConeCorners, EndsSidesAndAxes) {
  const ConeShape pipe{{0, 0, 0}, {0, 2, 0}, 1, 1}, lining{{0, 0, 0}, {0, 2, 0}, -1, -1},
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
