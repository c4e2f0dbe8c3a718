// Traces mirror rays about the exact normal, for spheres far from the origin or far larger than
// their visible part. Each leaving ray is also intersected exactly, from the same floats, so the
// test detects wrong origins and normals as well as wrong intersection tests.
#include "tests/kernel/traverse/leaving.hpp"

namespace grelha::test {
namespace {

struct Seen {
  float radius;
  Float3 org, dir;
};

struct Mirrored {
  std::uint64_t rays = 0, met_again = 0, wrong = 0;
  double normal = 0;  ///< largest distance of a normal from the exact one, in eps
  double away = 0;    ///< largest, less 2^-42 of the radius, in eps of the point
};

/// Notes how far the surface is from the exact one of normal n.
void measure(Mirrored& m, const Surface& s, const oracle::V& n, float radius) {
  const oracle::V error = n - oracle::V(floats(s.normal));
  m.normal = std::max(m.normal, static_cast<double>(oracle::length(error) / oracle::kEps));
  const double unit = double(scalar::largest(s.point)) * scalar::kEps;
  m.away = std::max(m.away, (double(s.offset) - 0x1p-42 * radius) / unit);
}

void reflect(Mirrored& m, const Float3& center, const Seen& seen) {
  const Scene scene = one_sphere(center, seen.radius);
  const World world(scene, {.grid = false});
  const Float3 org = seen.org;
  const oracle::Ball ball{center, seen.radius};
  const oracle::Ray in{org, seen.dir};
  const auto exact = ball.first({org, seen.dir}, 0);
  RayList ray;
  ray.add(org, seen.dir);
  const Answers hit = scalar_hits(world, ray);
  if (hit.id[0] == kNoPrimitive || !exact ||
      oracle::length(oracle::V(org) - ball.center) < ball.radius)
    return;
  const Surface s = surface_at(world, 0, org, seen.dir, hit.t[0]);
  const oracle::V n = oracle::unit(in.point(exact->t) - ball.center);
  measure(m, s, n, seen.radius);
  const oracle::V out = in.dir - 2 * oracle::dot(n, in.dir) * n;
  const Float3 d{static_cast<float>(out.x), static_cast<float>(out.y), static_cast<float>(out.z)};
  const Float3 from = start_of(s, d);
  RayList leaving;
  leaving.add(from, d);
  const bool again = scalar_hits(world, leaving).id[0] != kNoPrimitive;
  ++m.rays;
  m.met_again += again;
  m.wrong += again != ball.first({from, d}, 0).has_value();
}

template <class Make, class Eye>
Mirrored mirror_off(std::uint64_t seeds, const Make& make, const Eye& eye) {
  Mirrored m;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    Random random(seed);
    const Float3 center = make(random);
    reflect(m, center, eye(random, center));
  }
  return m;
}

TEST(Leaving, MirrorRaysOfSpheresFarFromTheOrigin) {
  const auto make = [](Random& random) { return scaled(random.direction(), 1e6); };
  const auto eye = [](Random& random, const Float3& center) {
    const double radius = random.log_in(.06, 1.2);
    const Float3 org = at(center, random.log_in(2, 60), random.direction());
    return Seen{static_cast<float>(radius),
                org,
                minus(at(center, radius * random.unit(), random.direction()), org)};
  };
  const Mirrored m = mirror_off(20000, make, eye);
  EXPECT_GT(m.rays, 10000u);
  EXPECT_EQ(m.met_again, 0u);
  EXPECT_EQ(m.wrong, 0u);
  EXPECT_LT(m.normal, 1);  // half an ulp a component: sqrt(3) / 2 eps
}

TEST(Leaving, MirrorRaysOfFloorSpheres) {
  for (const double radius : {1e3, 1e4, 1e5, 1e6}) {
    const auto make = [&](Random&) { return Float3{0, static_cast<float>(-radius), 0}; };
    const auto eye = [&](Random& random, const Float3&) {
      Float3 dir = random.direction();
      dir.y = -std::abs(dir.y);
      const Float3 org{
          static_cast<float>(random.in(-1, 1)), static_cast<float>(random.in(.5, 2)), 0};
      return Seen{static_cast<float>(radius), org, dir};
    };
    const Mirrored m = mirror_off(20000, make, eye);
    EXPECT_GT(m.rays, 18000u);
    EXPECT_EQ(m.met_again, 0u) << radius;
    EXPECT_EQ(m.wrong, 0u) << radius;
    EXPECT_LT(m.normal, 1) << radius;
    EXPECT_LT(m.away, 20.01) << radius;  // 4 and 16, whatever the radius
  }
}

}  // namespace
}  // namespace grelha::test
