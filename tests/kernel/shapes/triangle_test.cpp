// hit_triangle: every instruction set and method against the scalar one bit for bit; the scalar one
// against long double.
#include "tests/support/one_hit.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/triangles.hpp"

namespace grelha::test {
namespace {

class Triangle : public EveryVariant {};
GRELHA_FOR_EVERY_ISA(Triangle);

TEST_P(Triangle, ReturnsTheScalarBits) {
  std::size_t hits = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    double size;
    const Shape s = random_shape(random, size);
    const Scene scene = one_triangle(s.a, s.b, s.c);
    const World world(scene, {.grid = false});
    RayList rays = rays_about(random, s.a, size, kManyRays / 2);
    // and at its corners, edges and middle, which the sweep seldom meets
    while (rays.size() < kManyRays) {
      const double u = random.below(5) * .25, v = (1 - u) * random.below(5) * .25;
      const Float3 aim = at(at(s.a, u, minus(s.b, s.a)), v, minus(s.c, s.a)),
                   org = random.point(size * random.log_in(1, 1e3));
      rays.add(org, scaled(minus(aim, org), random.log_in(1e-3, 1e3)));
    }
    rays = with_odd_values(random, rays, seed % 2 ? .1 : 0);
    const Truth truth = truth_of(scene, rays);
    expect_truth(variant(), world, rays, truth, "seed " + std::to_string(seed));
    hits += hits_of(truth.closest);
  }
  EXPECT_GT(hits, 60u * kManyRays / 10);
}

OneHit hit(const Float3& o, const Float3& d, const Shape& s, float t_min = 0, float t_max = kInf) {
  return one_hit<grelha::Triangle>(
      exact_ray(o, d, t_min),
      {{{s.a.x, s.a.y, s.a.z}, {s.b.x, s.b.y, s.b.z}, {s.c.x, s.c.y, s.c.z}}},
      t_max);
}

/// What is shaded.
scalar::Vec3<double> weights(const Float3& o, const Float3& d, const Shape& s) {
  const int k = scalar::largest_axis(d.x, d.y, d.z);
  return scalar::weights_at<double>(scalar::to_double<0>(permute_axes(o, k)),
                                    scalar::to_double<0>(permute_axes(d, k)),
                                    scalar::to_double<0>(vertices_of(s, k)))
      .weight;
}

/// Farthest corner from the origin: a sheared corner is off by a few eps of that, and so is all
/// that follows.
oracle::Real extent_of(const Float3& o, const Shape& s) {
  return std::max({length(oracle::V(s.a) - oracle::V(o)),
                   length(oracle::V(s.b) - oracle::V(o)),
                   length(oracle::V(s.c) - oracle::V(o))});
}

/// Decisions are those of doubles. A sheared coordinate takes the roundings of two differences, two
/// products and one more difference, each of at most 2 max|corner - org|: 8 of 2^-53 of these on
/// each of two axes, so the ray passes the sheared outline within 8 sqrt(2) < 12 of these of where
/// it passes the true one.
constexpr oracle::Real kOutline = 12 * 0x1p-53L;

TEST(TriangleOracle, DecidesLikeTheExactOutline) {
  int judged = 0, inside = 0;
  for (std::uint64_t seed = 0; seed < 400000; ++seed) {
    Random random(seed);
    double size;
    const Shape s = random_shape(random, size);
    const double u = random.in(-.2, 1.2), v = random.in(-.2, 1.2 - u);
    const Float3 aim = at(at(s.a, u, minus(s.b, s.a)), v, minus(s.c, s.a));
    const Float3 o = at(s.a, size * random.log_in(1e-1, 1e4), random.direction());
    const Float3 d = scaled(minus(aim, o), random.log_in(1e-2, 1e2));
    const oracle::Facet facet{s.a, s.b, s.c};
    const oracle::Ray ray{o, d};
    const oracle::Real clear = facet.clearance(ray), tolerance = kOutline * extent_of(o, s);
    if (std::abs(clear) <= tolerance || facet.distance(ray.org) <= 32 * tolerance)
      continue;
    const oracle::Real t_plane =
        dot(facet.a - ray.org, facet.normal()) / dot(ray.dir, facet.normal());
    ++judged;
    inside += clear > 0;
    ASSERT_EQ(hit(o, d, s).hit, clear > 0 && t_plane > 0)
        << "seed " << seed << ", " << static_cast<double>(clear / tolerance) << " clear";
  }
  EXPECT_GT(judged, 100000);
  EXPECT_GT(inside, 20000);
}

/// How far the point found lies from the triangle, slivers included: kernel/shapes/triangle.hpp
/// and docs/proofs.md say 46 eps reach. The weights are of doubles: the point they make lies on
/// the ray but for some 64 roundings of the reach, which slivers lengthen.
TEST(TriangleOracle, PointsLieOnTheTriangle) {
  oracle::Real worst = 0;
  oracle::Real worst_weights = 0;
  int hits = 0;
  int slivers = 0;
  int over = 0;
  for (std::uint64_t seed = 0; seed < 400000; ++seed) {
    Random random(seed);
    double size;
    const Shape s = random_shape(random, size);
    const double u = random.unit();
    const double v = (1 - u) * random.unit();
    const Float3 aim = at(at(s.a, u, minus(s.b, s.a)), v, minus(s.c, s.a));
    const Float3 o = at(s.a, size * random.log_in(1e-1, 1e4), random.direction());
    const Float3 d = scaled(minus(aim, o), random.log_in(1e-2, 1e2));
    const OneHit h = hit(o, d, s);
    if (!h.hit)
      continue;
    ++hits;
    const oracle::Facet facet{s.a, s.b, s.c};
    const oracle::Ray ray{o, d};
    const oracle::V direction = oracle::unit(d);
    const oracle::Real l =
        std::max({length(facet.b - facet.a), length(facet.c - facet.a), length(facet.c - facet.b)});
    const oracle::Real slenderness = l * l / std::abs(dot(facet.normal(), direction));
    slivers += slenderness > 1000;
    const oracle::Real unit = oracle::kEps * extent_of(o, s);
    const oracle::Real error = facet.distance(ray.point(h.t));
    const scalar::Vec3<double> w = weights(o, d, s);
    const oracle::V gap =
        (facet.a - ray.org) + w.y * (facet.b - facet.a) + w.z * (facet.c - facet.a);
    const oracle::Real beside = length(gap - dot(gap, direction) * direction);
    const oracle::Real weights_unit =
        0x1p-53L * extent_of(o, s) * std::max(slenderness, oracle::Real(1));
    if (!(error <= 46 * unit && beside <= 64 * weights_unit) && ++over <= 3)
      ADD_FAILURE() << "seed " << seed << ": " << double(error / unit) << " and "
                    << double(beside / weights_unit) << " units off";
    worst = std::max(worst, error / unit);
    worst_weights = std::max(worst_weights, beside / weights_unit);
  }
  std::printf(
      "triangle: %d hits, %d on slivers, off the triangle %.2f eps reach, off the ray %.2f 2^-53 "
      "reach and slenderness\n",
      hits,
      slivers,
      double(worst),
      double(worst_weights));
  EXPECT_EQ(over, 0);
  EXPECT_GT(hits, 100000);
  EXPECT_GT(slivers, 1000);
}

/// Two triangles, a square of half side `half` about a point near the eye, tilted any way.
struct Floor {
  Shape halves[2];
  oracle::V normal;
};

Floor random_floor(Random& random, double half, const Float3& middle, bool flat) {
  const Float3 n = flat ? Float3{0, 0, 1} : random.direction();
  const Float3 any = random.direction();
  const oracle::V e = oracle::unit(cross(oracle::V(n), oracle::V(any)));
  const oracle::V f = cross(oracle::V(n), e);
  const auto corner = [&](double x, double y) {
    const oracle::V p = oracle::V(middle) + (half * x) * e + (half * y) * f;
    return Float3{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  };
  const Float3 a = corner(-1, -1), c = corner(1, 1);
  return {{{a, corner(1, -1), c}, {a, c, corner(-1, 1)}}, oracle::V(n)};
}

/// t of floors from 1 to a million units wide, flat and tilted, at the origin and away from it,
/// seen from .03 to 2 units above at all angles down to 1e-3: within 8 eps of where the ray hits
/// the plane of the very corners. Floats alone were off by up to 2 %.
TEST(TriangleOracle, FloorsOfAnySizeAreMetWhereTheyAre) {
  constexpr oracle::Real kMost = 8;
  for (const bool flat : {true, false}) {
    for (double half = 1; half <= 1e6; half *= 10) {
      oracle::Real worst = 0;
      int hits = 0;
      int lost = 0;
      for (std::uint64_t seed = 0; seed < 20000; ++seed) {
        Random random(seed);
        const double offset = random.chance(.5) ? 0 : random.log_in(1, 1e3);
        const Float3 middle = random.point(offset);
        const Floor floor = random_floor(random, half, middle, flat);
        const Float3 n{float(floor.normal.x), float(floor.normal.y), float(floor.normal.z)};
        const double height = random.chance(.5) ? random.in(1, 2) : random.log_in(.03, 1);
        const Float3 aside = random.direction();
        const Float3 along = at(aside, -double(dot(oracle::V(aside), floor.normal)), n);
        const Float3 o =
            at(at(middle, height, n), random.chance(.5) ? 0 : .3 * half * random.unit(), along);
        Float3 d = random.direction();
        const double down = double(dot(oracle::V(d), floor.normal));
        d = at(d, -down - (down < 0 ? -1 : 1) * std::abs(down) * random.log_in(1e-3, 1), n);
        for (const Shape& s : floor.halves) {
          const oracle::Facet facet{s.a, s.b, s.c};
          const oracle::Ray ray{o, d};
          const oracle::Real away = dot(facet.a - ray.org, facet.normal());
          const OneHit h = hit(o, d, s);
          const oracle::Real t = away / dot(ray.dir, facet.normal());
          if (!h.hit) {
            lost += t > 0 && facet.clearance(ray) > kOutline * extent_of(o, s);
            continue;
          }
          ++hits;
          worst = std::max(worst, std::abs(h.t / t - 1) / oracle::kEps);
        }
      }
      EXPECT_LE(worst, kMost) << (flat ? "flat" : "tilted") << " floor of half side " << half;
      EXPECT_EQ(lost, 0) << (flat ? "flat" : "tilted") << " floor of half side " << half;
      EXPECT_GT(hits, 100);
    }
  }
}

/// Moves the ends of the search interval below and above t, by one ulp, by some hundred and by up
/// to 1/2 of t. For floors of any size floats must lose no hit and find no false one.
TEST(TriangleOracle, EndsOfASearchDecideAsExactNumbersDo) {
  int hits = 0;
  int near = 0;
  for (std::uint64_t seed = 0; seed < 50000; ++seed) {
    Random random(seed);
    const Floor floor = random_floor(random, random.log_in(1, 1e6), {}, random.chance(.2));
    const Float3 o = at({}, random.log_in(.03, 2), random.direction());
    const Float3 d = random.direction();
    for (const Shape& s : floor.halves) {
      const OneHit whole = hit(o, d, s);
      if (!whole.hit)
        continue;
      ++hits;
      const float by = random.chance(.5) ? float(random.log_in(0x1p-24, 0x1p-15))
                                         : float(random.log_in(0x1p-15, .5));
      for (const float end : {whole.t, whole.t * (1 + by), whole.t * (1 - by)}) {
        near += end != whole.t && by < 0x1p-20f;
        const bool met = hit(o, d, s, 0, end).hit || hit(o, d, s, end).hit;
        EXPECT_TRUE(met || end == whole.t) << "seed " << seed;
      }
    }
  }
  EXPECT_GT(hits, 5000);
  EXPECT_GT(near, 1000);
}

/// The triangle and the ray of a report, t by hand.
TEST(TriangleOracle, AFloorOfTwoThousandUnits) {
  const Shape s{{2000, 2000, 0}, {-2000, -2000, 0}, {2000, -2000, 0}};
  const OneHit h = hit({.9f, -1.5f, .95f}, {-.289602369f, .708382249f, -.643680871f}, s);
  EXPECT_TRUE(h.hit);
  EXPECT_NEAR(h.t, 1.47588663, 2e-7);
}

TEST(TriangleCorners, EdgesCornersAndSides) {
  const Shape s{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, back{{0, 0, 0}, {0, 4, 0}, {4, 0, 0}};
  for (const Shape& k : {s, back}) {
    EXPECT_EQ(hit({1, 1, 5}, {0, 0, -1}, k).t, 5);
    EXPECT_EQ(hit({1, 1, -5}, {0, 0, 2}, k).t, 2.5f);
    EXPECT_TRUE(hit({0, 0, 5}, {0, 0, -1}, k).hit);
    EXPECT_TRUE(hit({4, 0, 5}, {0, 0, -1}, k).hit);
    EXPECT_TRUE(hit({2, 0, 5}, {0, 0, -1}, k).hit);
    EXPECT_TRUE(hit({2, 2, 5}, {0, 0, -1}, k).hit);
    EXPECT_TRUE(hit({0, -0.f, 5}, {-0.f, 0, -1}, k).hit);
    EXPECT_FALSE(hit({2, 2.000001f, 5}, {0, 0, -1}, k).hit);
    EXPECT_FALSE(hit({2, -1e-30f, 5}, {0, 0, -1}, k).hit);
    EXPECT_FALSE(hit({1, 1, 5}, {0, 0, 1}, k).hit);
    EXPECT_FALSE(hit({-1, 1, 0}, {1, 0, 0}, k).hit);     // in its plane
    EXPECT_FALSE(hit({1, 1, 5}, {0, 0, -1}, k, 5).hit);  // the interval is open
  }
  EXPECT_FALSE(hit({1, 0, 5}, {0, 0, -1}, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}).hit);  // no area
  EXPECT_FALSE(hit({0, 0, 5}, {0, 0, -1}, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}).hit);
}

/// An edge function that is zero in float but not in truth: of two neighbours exactly one is hit,
/// the one that holds the ray. (1 + 2^-22) 1 and (1 + 2^-23)^2 round alike and differ by 2^-46.
TEST(TriangleCorners, ZeroEdgesAreTakenAgain) {
  for (const float k : {1.f, 1e-10f, 1e10f}) {
    const auto point = [&](float x, float y) { return Float3{x * k, y * k, 0}; };
    const Float3 b = point(1 + 0x1p-23f, 1), c = point(-1 - 0x1p-22f, -1 - 0x1p-23f),
                 left = point(-1, 1), right = point(1, -1);
    if (k != 1) {  // scaled corners round anew; what must stay is that the pair has no hole
      EXPECT_GE(hit({0, 0, 5 * k}, {0, 0, -1}, {left, b, c}).hit +
                    hit({0, 0, 5 * k}, {0, 0, -1}, {right, b, c}).hit,
                1)
          << k;
      continue;
    }
    const bool in_left = hit({0, 0, 5}, {0, 0, -1}, {left, b, c}).hit,
               in_right = hit({0, 0, 5}, {0, 0, -1}, {right, b, c}).hit;
    EXPECT_NE(in_left, in_right);
    const oracle::Facet facet{left, b, c};
    EXPECT_EQ(in_left, facet.clearance({oracle::V{0, 0, 5}, oracle::V{0, 0, -1}}) > 0);
  }
}

/// Embree #387: a sliver hit at half a degree was reported at twenty times the distance of its
/// farthest corner.
TEST(TriangleCorners, DepthStaysWithinThatOfTheCorners) {
  for (std::uint64_t seed = 0; seed < 100000; ++seed) {
    Random random(seed);
    const Float3 a = random.point(10);
    const Shape s{a, at(a, 11.2, random.direction()), at(a, 1.4, random.direction())};
    const Float3 aim = at(at(a, .3, minus(s.b, a)), .3, minus(s.c, a));
    // Nearly in the plane: along an edge, tilted by half a degree or a thousandth of it.
    const Float3 d = at(minus(s.b, a), 11.2 * random.log_in(1e-5, 1e-2), random.direction()),
                 o = at(aim, -50, d);
    const OneHit h = hit(o, d, s, -kInf);
    if (!h.hit)
      continue;
    const int k = scalar::largest_axis(d.x, d.y, d.z);
    const auto depth = [&](const Float3& p) {
      const oracle::Real q[3] = {oracle::Real(p.x) - o.x,
                                 oracle::Real(p.y) - o.y,
                                 oracle::Real(p.z) - o.z},
                         r[3] = {d.x, d.y, d.z};
      return q[k] / r[k];
    };
    const oracle::Real least = std::min({depth(s.a), depth(s.b), depth(s.c)}),
                       most = std::max({depth(s.a), depth(s.b), depth(s.c)});
    const oracle::Real slack = 8 * oracle::kEps * std::max(std::abs(least), std::abs(most));
    ASSERT_TRUE(h.t >= least - slack && h.t <= most + slack) << "seed " << seed << ": t " << h.t;
  }
}

}  // namespace
}  // namespace grelha::test
