// Planes: every instruction set and method against the reference bit for bit; exact numbers
// against long double, floats and doubles against exact numbers.
#include "kernel/shapes/plane.hpp"

#include "tests/support/one_hit.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

class Plane : public EveryVariant {};
GRELHA_FOR_EVERY_ISA(Plane);

TEST_P(Plane, ReturnsTheScalarBits) {
  std::size_t hits = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const double size = random.log_in(1e-12, 1e12);
    const Float3 point = random.point(size);
    Float3 normal = scaled(random.direction(), random.log_in(1e-3, 1e3));
    if (seed % 4 == 0)
      normal = {0, random.chance(.5) ? 1.f : -2.f, random.zero()};
    const Scene scene = one_plane(point, normal);
    const World world(scene, {});
    const RayList rays =
        with_odd_values(random, rays_about(random, point, size, kManyRays), seed % 2 ? .1 : 0);
    const Truth truth = truth_of(scene, rays);
    expect_truth(variant(), world, rays, truth, "seed " + std::to_string(seed));
    hits += hits_of(truth.closest);
  }
  EXPECT_GT(hits, 60u * kManyRays / 5);
}

/// The header's bound: t within 6 eps |point - org| |normal| / |dir . normal| of the exact one. The
/// dot product below the fraction cancels for grazing rays, which costs t itself a share of eps
/// |dir| |normal| / |dir . normal|.
TEST(PlaneOracle, KeepsTheBound) {
  oracle::Real worst = 0;
  int hits = 0;
  for (std::uint64_t seed = 0; seed < 300000; ++seed) {
    Random random(seed);
    const double size = random.log_in(1e-12, 1e12);
    const Float3 p = random.point(size), o = random.point(size * random.log_in(1, 1e4));
    const Float3 n = scaled(random.direction(), random.log_in(1e-3, 1e3));
    const Float3 d = scaled(minus(at(p, size * random.log_in(1e-2, 1e2), random.direction()), o),
                            random.log_in(1e-3, 1e3));
    const oracle::Sheet sheet{p, n};
    const oracle::Ray ray{o, d};
    const oracle::Real along = std::abs(dot(ray.dir, sheet.normal)),
                       sine = along / (length(ray.dir) * length(sheet.normal));
    if (sine < 1e-3L)
      continue;  // from here on the bound's first order is all there is
    const auto [found, t] =
        one_hit<grelha::Plane>(exact_ray(o, d), {{p.x, p.y, p.z}, {n.x, n.y, n.z}});
    const auto wanted = sheet.first(ray, -1e30L);
    const oracle::Real bound =
        oracle::kEps * (length(sheet.point - ray.org) * length(sheet.normal) / along +
                        std::abs(wanted->t) * (1 + 1 / sine));
    if (std::abs(wanted->t) > 6 * bound) {
      ASSERT_EQ(found, wanted->t > 0) << "seed " << seed;
    }
    if (!found)
      continue;
    ++hits;
    const oracle::Real error = std::abs(t - wanted->t) / bound;
    ASSERT_LE(error, 6) << "seed " << seed << ": t " << t << " against "
                        << static_cast<double>(wanted->t);
    worst = std::max(worst, error);
  }
  std::printf("plane: %d hits, worst %.2f of eps(...)\n", hits, static_cast<double>(worst));
  EXPECT_GT(hits, 100000);
}

TEST(PlaneCorners, ParallelRaysMiss) {
  const auto hit = [](const Float3& o, const Float3& d) {
    return one_hit<grelha::Plane>(exact_ray(o, d), {{0, 1, 0}, {0, 1, 0}}).t;
  };
  EXPECT_EQ(hit({0, 0, 0}, {1, 0, 0}), -1);
  EXPECT_EQ(hit({0, 0, 0}, {1, -0.f, 0}), -1);
  EXPECT_EQ(hit({0, 1, 0}, {1, 0, 0}), -1);  // in the plane
  EXPECT_EQ(hit({0, 0, 0}, {0, .5f, 0}), 2);
  EXPECT_EQ(hit({0, 3, 0}, {9, -1, 0}), 2);
  EXPECT_EQ(hit({0, 0, 0}, {0, -1, 0}), -1);
}

}  // namespace
}  // namespace grelha::test
