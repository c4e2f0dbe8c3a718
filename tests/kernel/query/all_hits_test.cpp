// All hits of a ray, counts of them, primitives that are left out, and barycentric coordinates.
#include "grelha/all_hits.hpp"
#include "grelha/inside.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "kernel/query/variants.hpp"
#include "tests/support/brute_force.hpp"
#include "tests/support/closed.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

Ray random_ray(Random& random) {
  const Float3 org = random.point(2), to = random.point(1);
  Ray ray{org, minus(to, org)};
  if (random.chance(.3))
    ray.t_min = static_cast<float>(random.in(-1, 1));
  if (random.chance(.3))
    ray.t_max = static_cast<float>(random.in(.5, 2));
  return ray;
}

std::vector<Ray> random_rays(std::uint64_t seed, std::size_t count) {
  Random random(seed);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays)
    ray = random_ray(random);
  return rays;
}

TEST(AllHits, AreThoseOfBruteForce) {
  std::size_t judged = 0, hits = 0;
  for (const std::uint64_t seed : {1u, 2u, 3u})
    for (const float density : {0.f, 4.f}) {
      const Scene s = random_mixture(seed, 240);
      const World world(s, {.density = density});
      for (const Ray& ray : random_rays(seed + 10, 2000)) {
        const brute::RayThroughScene truth(s, ray);
        if (!truth.crossings().is_clear)
          continue;
        const std::vector<brute::Crossing>& expected = truth.crossings().list;
        const std::vector<Hit> found = all_hits(world, ray);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
          ASSERT_EQ(found[i].id, expected[i].id) << "hit " << i;
          EXPECT_NEAR(found[i].t, static_cast<double>(expected[i].t), 1e-4);
        }
        ++judged;
        hits += found.size();
      }
    }
  EXPECT_GT(judged, 6000u);
  EXPECT_GT(hits, 25000u);
}

TEST(AllHits, BeginWithTheClosest) {
  const Scene s = random_mixture(4, 300);
  const World world(s, {});
  for (const Ray& ray : random_rays(5, 3000)) {
    const Hit closest_hit = closest(world, ray);
    const std::vector<Hit> all = all_hits(world, ray);
    ASSERT_EQ(all.empty(), !closest_hit);
    if (all.empty())
      continue;
    EXPECT_EQ(all.front().id, closest_hit.id);
    EXPECT_EQ(all.front().t, closest_hit.t);
  }
}

/// Directions of any length, starts near and far, ends before and behind hits.
std::vector<Ray> rays_of_any_length(std::uint64_t seed, std::size_t count) {
  std::vector<Ray> rays = random_rays(seed, count);
  Random random(seed);
  for (Ray& ray : rays) {
    if (random.chance(.3))
      ray.org = at(ray.org, random.chance(.5) ? -20 : -1e5, ray.dir);
    if (random.chance(.3))
      ray.dir = at({0, 0, 0}, random.log_in(1e-7, 1e7), ray.dir);
  }
  return rays;
}

TEST(AllHits, OfAStreamAreThoseOfEachRay) {
  Scene s = random_mixture(6, 300);
  for (std::size_t i = 0; i < s.geometry.spheres.size(); i += 3)
    s.geometry.spheres.radius[i] *= -1;  // seen from inside alone
  const World world(s, {});
  std::vector<Ray> rays = rays_of_any_length(7, 6000);
  std::vector<std::vector<Hit>> expected;
  std::vector<std::vector<Crossing>> expected_crossings;
  Random random(8);
  for (Ray& ray : rays) {
    if (const std::vector<Hit> all = all_hits(world, ray); !all.empty() && random.chance(.3))
      ray.t_max = all[random.below(static_cast<std::uint32_t>(all.size()))].t;
    expected.push_back(all_hits(world, ray));
    expected_crossings.push_back(crossings(world, ray));
  }
  const auto expect_same = [&](const QueryOptions& options) {
    const HitLists lists = all_hits(world, Rays::of(rays), options);
    const CrossingLists crossed = crossings(world, Rays::of(rays), options);
    std::vector<std::uint32_t> counts(rays.size());
    std::vector<std::uint32_t> crossing_counts(rays.size());
    count_hits(world, Rays::of(rays), counts.data(), options);
    count_crossings(world, Rays::of(rays), crossing_counts.data(), options);
    ASSERT_EQ(lists.offset.size(), rays.size() + 1);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::vector<Hit>& one = expected[i];
      ASSERT_EQ(lists.of(i).size(), one.size());
      ASSERT_EQ(counts[i], one.size());
      ASSERT_EQ(crossed.of(i).size(), expected_crossings[i].size());
      ASSERT_EQ(crossing_counts[i], expected_crossings[i].size());
      for (std::size_t k = 0; k < one.size(); ++k) {
        EXPECT_EQ(lists.of(i)[k].id, one[k].id);
        EXPECT_EQ(lists.of(i)[k].t, one[k].t);
      }
      for (std::size_t k = 0; k < crossed.of(i).size(); ++k) {
        EXPECT_EQ(crossed.of(i)[k].id, expected_crossings[i][k].id);
        EXPECT_EQ(crossed.of(i)[k].t, expected_crossings[i][k].t);
      }
    }
  };
  expect_same({.threads = 3});
  for (const Variant* variant : variants())
    if (variant->is_supported())
      expect_same({.isa = variant->name});
}

TEST(AllHits, StopWhenTheVisitorSaysSo) {
  Scene s = empty_scene();
  for (const float radius : {1.f, 2.f, 3.f})
    s.geometry.spheres.add({0, 0, 0}, radius, 0);
  const World world(s, {});
  const Ray ray{{-5, .1f, .1f}, {1, 0, 0}};
  ASSERT_EQ(all_hits(world, ray).size(), 6u);
  std::size_t seen = 0;
  all_hits(world, ray, [&](const Hit&) { return ++seen < 2; });
  EXPECT_EQ(seen, 2u);
}

TEST(AllHits, OfEqualTComeInOrderOfId) {
  Scene s = empty_scene();
  for (const float z : {3.f, 2.f, 3.f, 2.f}) {
    const float shift = static_cast<float>(s.geometry.triangles.size()) * .125f;
    add_triangle(s, {-9 - shift, -9, z}, {9, -9, z}, {0, 9 + shift, z});
  }
  const World world(s, {});
  const std::vector<Hit> hits = all_hits(world, {{.1f, .1f, 0}, {0, 0, 1}});
  ASSERT_EQ(hits.size(), 4u);
  const std::uint32_t expected[] = {1, 3, 0, 2};
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(hits[i].id, expected[i]);
}

TEST(Filter, LeavesOutWhatItNames) {
  const Scene s = random_mixture(9, 300);
  const World world(s, {});
  Random random(10);
  std::vector<std::uint8_t> masks(s.geometry.planes.size() + s.geometry.spheres.size() +
                                  s.geometry.triangles.size() + s.geometry.cones.size());
  for (std::uint8_t& mask : masks)
    mask = static_cast<std::uint8_t>(1u << random.below(3));
  const std::vector<Ray> rays = random_rays(11, 5000);
  std::vector<std::uint32_t> skip(rays.size());
  std::vector<std::uint8_t> ray_mask(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit hit = closest(world, rays[i]);
    skip[i] = random.chance(.8) ? hit.id : kNoPrimitive;
    ray_mask[i] = static_cast<std::uint8_t>(random.below(8));
  }
  Rays view = Rays::of(rays);
  view.skip = skip.data();
  view.mask = ray_mask.data();
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> blocked(rays.size());
  const QueryOptions options{.threads = 2, .mask = masks};
  closest(world, view, Hits::of(hits), options);
  occluded(world, view, blocked.data(), options);
  std::size_t differ = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Hit expected{rays[i].t_max, kNoPrimitive};
    for (const Hit& hit : all_hits(world, rays[i]))
      if (!expected && hit.id != skip[i] && (masks[hit.id] & ray_mask[i]) != 0)
        expected = hit;
    ASSERT_EQ(hits[i].id, expected.id) << "ray " << i;
    EXPECT_EQ(hits[i].t, expected.t);
    EXPECT_EQ(blocked[i] != 0, expected.id != kNoPrimitive);
    const Filter filter{skip[i], masks, ray_mask[i]};
    EXPECT_EQ(closest(world, rays[i], filter).id, expected.id);
    EXPECT_EQ(occluded(world, rays[i], filter), expected.id != kNoPrimitive);
    differ += expected.id != closest(world, rays[i]).id;
  }
  EXPECT_GT(differ, 1000u);
}

TEST(Filter, RefusesMasksOfAnotherLength) {
  const Scene s = random_spheres(12, 10);
  const World world(s, {});
  const std::vector<std::uint8_t> masks(9);
  const Ray ray{{0, 0, -5}, {0, 0, 1}};
  EXPECT_THROW(closest(world, ray, Filter{.masks = masks}), std::invalid_argument);
  EXPECT_THROW(all_hits(world, ray, Filter{.masks = masks}), std::invalid_argument);
  EXPECT_THROW(all_hits(world, Rays::of(std::span(&ray, 1)), {.mask = masks}),
               std::invalid_argument);
}

TEST(Barycentric, MeetTheHitPoint) {
  const Scene s = torus_mesh(30, 20, .4);
  const World world(s, {});
  const Triangles& t = s.geometry.triangles;
  const std::vector<Ray> rays = random_rays(13, 20000);
  std::vector<Hit> hits(rays.size());
  std::vector<float> u(rays.size()), v(rays.size());
  Hits view = Hits::of(hits);
  view.u = u.data();
  view.v = v.data();
  closest(world, Rays::of(rays), view);
  std::size_t count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!hits[i]) {
      EXPECT_EQ(u[i], 0);
      EXPECT_EQ(v[i], 0);
      continue;
    }
    ++count;
    ASSERT_GE(u[i], 0);
    ASSERT_GE(v[i], 0);
    ASSERT_LE(u[i] + v[i], 1);
    const std::uint32_t k = hits[i].id;
    const oracle::V a = brute::v(vertex(s, t.a[k])), b = brute::v(vertex(s, t.b[k])),
                    c = brute::v(vertex(s, t.c[k]));
    const oracle::V p = a + oracle::Real(u[i]) * (b - a) + oracle::Real(v[i]) * (c - a);
    const oracle::V q = brute::v(rays[i].org) + oracle::Real(hits[i].t) * brute::v(rays[i].dir);
    EXPECT_LT(length(p - q), 1e-5L) << "ray " << i;
  }
  EXPECT_GT(count, 5000u);
}

TEST(Threads, ChangeNoBit) {
  const Scene s = random_mixture(14, 400);
  const World world(s, {});
  const std::vector<Ray> rays = random_rays(15, 30001);
  std::vector<Hit> one(rays.size()), many(rays.size());
  TraceCounts counts_of_one, counts_of_many;
  closest(world, rays, one, {}, &counts_of_one);
  closest(world, rays, many, {.threads = 4}, &counts_of_many);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(one[i].t, many[i].t);
    ASSERT_EQ(one[i].id, many[i].id);
  }
  EXPECT_GT(counts_of_many.visits, counts_of_one.visits / 2);
  EXPECT_THROW(closest(world, rays, many, {.threads = -1}), std::invalid_argument);
}

TEST(Threads, StopAndReportProgress) {
  const Scene s = random_spheres(16, 100);
  const World world(s, {});
  const std::vector<Ray> rays = random_rays(17, 100000);
  std::vector<Hit> hits(rays.size());
  double last = 0;
  closest(world, rays, hits, {.threads = 2, .progress = [&](double share) {
                                EXPECT_GT(share, last);
                                last = share;
                                return true;
                              }});
  EXPECT_EQ(last, 1);
  int calls = 0;
  const QueryOptions stop{.threads = 2, .progress = [&](double) { return ++calls < 3; }};
  EXPECT_THROW(closest(world, rays, hits, stop), Stopped);
  EXPECT_EQ(calls, 3);
}

TEST(Contains, MatchesTheDistanceToACenter) {
  const Scene s = ball_mesh(40, 20);
  const World world(s, {});
  Random random(18);
  std::vector<Float3> points(3000);
  for (Float3& p : points)
    p = random.point(1.5);
  std::vector<std::uint8_t> inside(points.size());
  contains(world, points, inside, {.threads = 2});
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double r = static_cast<double>(length(brute::v(points[i])));
    if (r < .97 || r > 1.001) {
      EXPECT_EQ(inside[i] != 0, r < 1) << r;
    }
    EXPECT_EQ(contains(world, points[i]), inside[i] != 0);
  }
  EXPECT_FALSE(contains(world, {kNaN, 0, 0}));
}

}  // namespace
}  // namespace grelha::test
