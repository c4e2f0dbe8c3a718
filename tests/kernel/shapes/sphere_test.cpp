// Spheres: every instruction set and method against the reference bit for bit; exact numbers
// against long double, floats and doubles against exact numbers.
#include "kernel/shapes/sphere.hpp"

#include "tests/support/one_hit.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

class Sphere : public EveryVariant {};
GRELHA_FOR_EVERY_ISA(Sphere);

TEST_P(Sphere, ReturnsTheScalarBits) {
  std::size_t hits = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const double size = random.log_in(1e-12, 1e12);
    const Float3 center = random.chance(.3) ? Float3{} : random.point(size * random.log_in(1, 1e4));
    const Scene scene = one_sphere(center, static_cast<float>(random.chance(.2) ? -size : size));
    const World world(scene, {.grid = false});
    const RayList rays =
        with_odd_values(random, rays_about(random, center, size, kManyRays), seed % 2 ? .1 : 0);
    const Truth truth = truth_of(scene, rays);
    expect_truth(variant(), world, rays, truth, "seed " + std::to_string(seed));
    hits += hits_of(truth.closest);
  }
  EXPECT_GT(hits, 60u * kManyRays / 4);  // or the sweep says nothing
}

OneHit hit(const Float3& o, const Float3& d, const Float3& c, float radius, float t_min = 0) {
  return one_hit<grelha::Sphere>(exact_ray(o, d, t_min), {{c.x, c.y, c.z}, radius});
}

/// The header's bound: 8 eps max(radius, distance of the origin from the centre), measured from the
/// surface.
TEST(SphereOracle, PointsLieOnTheSurface) {
  oracle::Real worst = 0;
  int hits = 0;
  for (std::uint64_t seed = 0; seed < 300000; ++seed) {
    Random random(seed);
    const double r = random.log_in(1e-12, 1e12);
    const Float3 c = random.chance(.3) ? Float3{} : random.point(r * random.log_in(1e-2, 1e2));
    const Float3 o = at(c, r * random.log_in(1e-3, 1e5), random.direction());
    const Float3 d = scaled(minus(at(c, r * random.in(0, 1.001), random.direction()), o),
                            random.log_in(1e-2, 1e2));
    const auto [found, t] = hit(o, d, c, static_cast<float>(r));
    if (!found)
      continue;
    ++hits;
    const oracle::Ball ball{c, static_cast<float>(r)};
    const oracle::Real unit =
        oracle::kEps * std::max<oracle::Real>(ball.radius, length(oracle::V(o) - ball.center));
    const oracle::Real error = ball.distance(oracle::Ray{o, d}.point(t)) / unit;
    ASSERT_LE(error, 8) << "seed " << seed << ": " << static_cast<double>(error) << " of the unit";
    worst = std::max(worst, error);
  }
  RecordProperty("worst_in_eps", std::to_string(static_cast<double>(worst)));
  std::printf(
      "sphere: %d hits, worst %.2f eps max(r, |o - c|)\n", hits, static_cast<double>(worst));
  EXPECT_GT(hits, 100000);
}

/// Misses and hits agree with the exact ones, and the first crossing is found, wherever 8 eps
/// cannot tip the balance: a ray whose line keeps further than that from the silhouette, that
/// starts further than that from the surface.
TEST(SphereOracle, FindsTheFirstCrossing) {
  int judged = 0;
  for (std::uint64_t seed = 0; seed < 300000; ++seed) {
    Random random(seed);
    const double size = random.log_in(1e-12, 1e12);
    const float r = static_cast<float>(random.chance(.3) ? -size : size);
    const Float3 c = random.point(size * random.log_in(1e-2, 1e3));
    const Float3 o = at(
        c, size * (random.chance(.3) ? random.unit() : random.log_in(1, 1e4)), random.direction());
    const Float3 d = scaled(minus(at(c, size * random.in(0, 1.5), random.direction()), o),
                            random.log_in(1e-2, 1e2));
    const oracle::Ball ball{c, r};
    const oracle::Ray ray{o, d};
    const oracle::Real tolerance =
        8 * oracle::kEps * std::max<oracle::Real>(size, length(oracle::V(o) - ball.center));
    const oracle::Real foot = dot(ball.center - ray.org, ray.dir) / dot(ray.dir, ray.dir);
    if (ball.distance(ray.org) <= tolerance || ball.distance(ray.point(foot)) <= tolerance)
      continue;
    ++judged;
    const auto wanted = ball.first(ray, 0);
    const auto [found, t] = hit(o, d, c, r);
    ASSERT_EQ(found, wanted.has_value()) << "seed " << seed;
    if (!found)
      continue;
    // Across a sphere the point moves 1/cosine as far along the ray as off the surface; twice for
    // its curvature.
    const oracle::Real along = std::abs(t - wanted->t) * length(ray.dir);
    ASSERT_LE(along * wanted->cosine, 2 * tolerance)
        << "seed " << seed << ": t " << t << " against " << static_cast<double>(wanted->t);
  }
  EXPECT_GT(judged, 280000);
}

/// From a billionth to a thirtieth of the radius above or below the surface |org - center|^2 and
/// radius^2 nearly agree, and floats leave little of their difference. Taken in double, the way is
/// right to its rounding, and inside or outside is decided exactly.
TEST(SphereOracle, MeasuresShortWays) {
  int hits = 0;
  int misses = 0;
  for (std::uint64_t seed = 0; seed < 300000; ++seed) {
    Random random(seed);
    const double r = random.log_in(1e-12, 1e12);
    const Float3 c = random.point(r * random.log_in(1e-2, 10));
    double height = random.log_in(1e-9, 1 / 40.) * (random.chance(.3) ? -1 : 1);
    Float3 out = random.direction();
    Float3 d = random.direction();
    if (random.chance(.3)) {
      // All but tangent: the line passes the centre at hardly more, or less, than the radius.
      const oracle::V along = oracle::unit(oracle::cross(oracle::V(out), oracle::V(d)));
      d = {static_cast<float>(along.x), static_cast<float>(along.y), static_cast<float>(along.z)};
      const double way = random.log_in(1e-4, .2);
      const double beside = 1 + random.log_in(1e-9, 1e-5) * (random.chance(.3) ? 1 : -1);
      const oracle::V from = static_cast<oracle::Real>(beside) * oracle::V(out) -
                             static_cast<oracle::Real>(way) * along;
      height = static_cast<double>(oracle::length(from)) - 1;
      const oracle::V unit = oracle::unit(from);
      out = {static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)};
    }
    const Float3 o = at(c, r * (1 + height), out);
    const oracle::Ball ball{c, static_cast<float>(r)};
    const auto wanted = ball.first({o, d}, 0);
    // Skip rays for which double hardly decides on which side they start or if they touch the
    // sphere.
    if (ball.distance(o) < 0x1p-40L * r)
      continue;
    const oracle::Real foot = oracle::dot(ball.center - o, d) / oracle::dot(d, d);
    if (ball.distance(oracle::Ray{o, d}.point(foot)) < 0x1p-40L * r)
      continue;
    const auto [found, t] = hit(o, d, c, static_cast<float>(r));
    ASSERT_EQ(found, wanted.has_value()) << "seed " << seed;
    if (!found) {
      ++misses;
      continue;
    }
    ++hits;
    // One rounding where double decides, and what is left of 2^-53 r^2 there; 8 eps of the sphere
    // for a way across.
    const bool across = wanted->t > .05L * r;
    const oracle::Real tolerance =
        across ? 8 * oracle::kEps * r / wanted->cosine : 1.01L * oracle::kEps * wanted->t;
    ASSERT_LE(std::abs(t - wanted->t), tolerance + 0x1p-40L * r / wanted->cosine)
        << "seed " << seed;
  }
  EXPECT_GT(hits, 100000);
  EXPECT_GT(misses, 50000);
}

TEST(SphereCorners, StartOnTheSurfaceAndInside) {
  EXPECT_TRUE(hit({0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 2).hit);
  EXPECT_EQ(hit({0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 2).t, 2.f);
  EXPECT_EQ(hit({0, 0, 5}, {0, 0, -1}, {0, 0, 0}, 2).t, 3.f);
  EXPECT_EQ(hit({0, 0, 5}, {0, 0, -4}, {0, 0, 0}, 2).t, .75f);  // t counts lengths of dir
  EXPECT_EQ(hit({0, 0, 5}, {0, 0, -1}, {0, 0, 0}, -2).t,
            7.f);  // inside only: the near half lets the ray in
  EXPECT_FALSE(hit({0, 0, 5}, {0, 0, 1}, {0, 0, 0}, 2).hit);
  EXPECT_EQ(hit({0, 0, 5}, {0, 0, -1}, {0, 0, 0}, 2, 3).t,
            7.f);  // the interval is open: t 3 itself does not count
  EXPECT_FALSE(hit({0, 0, 5}, {0, 0, -1}, {0, 0, 0}, 2, 7).hit);
  EXPECT_TRUE(hit({2, 0, 5}, {0, 0, -1}, {0, 0, 0}, 2).hit);  // touching
  EXPECT_FALSE(hit({2.0001f, 0, 5}, {0, 0, -1}, {0, 0, 0}, 2).hit);
}

}  // namespace
}  // namespace grelha::test
