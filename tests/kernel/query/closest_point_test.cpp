// Closest points and signed distances, against every primitive in long double.
#include "grelha/all_hits.hpp"
#include "grelha/distance.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/brute_force.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

void expect_closest(const World& world, const Scene& s, const Float3& p, double tolerance) {
  const std::vector<oracle::Real> all = brute::distances(s, p);
  const auto least = std::min_element(all.begin(), all.end());
  const ClosestPoint found = closest_point(world, p);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found.distance, static_cast<double>(*least), tolerance);
  EXPECT_NEAR(static_cast<double>(all[found.id]), static_cast<double>(*least), tolerance);
  EXPECT_NEAR(
      static_cast<double>(length(brute::v(found.point) - brute::v(p))), found.distance, tolerance);
  const auto radius = static_cast<float>(*least);
  EXPECT_TRUE(closest_point(world, p, radius * 1.001f + static_cast<float>(tolerance)));
  EXPECT_FALSE(closest_point(world, p, radius * .999f - static_cast<float>(tolerance)));
}

TEST(ClosestPoint, IsThatOfBruteForce) {
  Random random(1);
  for (const float density : {0.f, 30.f})
    for (const Scene& s :
         {random_triangles(2, 400), balls_and_triangles(3, 300), needles(4, 200)}) {
      const World world(s, {.density = density});
      for (int i = 0; i < 200; ++i) {
        const double size = random.chance(.2) ? 40 : 1.5;
        expect_closest(world, s, random.point(size), 2e-6 * size);
      }
    }
}

TEST(ClosestPoint, OfConesAndPlanes) {
  Random random(5);
  Scene s = random_cones(6, 60);
  s.geometry.planes.add({0, -1.5f, 0}, {.2f, 2, .1f}, 0);
  const World world(s, {});
  for (int i = 0; i < 150; ++i)
    expect_closest(world, s, random.point(1.5), 3e-6);
}

TEST(ClosestPoint, OfObjectsFarApart) {
  Random random(7);
  Scene s = mesh_in_a_vast_scene();
  const World world(s, {});
  for (int i = 0; i < 50; ++i)
    expect_closest(world, s, random.point(10), 1e-5);
}

TEST(ClosestPoint, ThereIsNone) {
  const Scene nothing = empty_scene();
  const World empty(nothing, {});
  EXPECT_FALSE(closest_point(empty, {1, 2, 3}));
  EXPECT_EQ(closest_point(empty, {1, 2, 3}).distance, kInf);
  const Scene ball = one_sphere({0, 0, 0}, 1);
  const World world(ball, {});
  EXPECT_FALSE(closest_point(world, {kNaN, 0, 0}));
  EXPECT_FALSE(closest_point(world, {0, kInf, 0}));
  EXPECT_FALSE(closest_point(world, {2, 0, 0}, .5f));
  EXPECT_TRUE(closest_point(world, {2, 0, 0}, 1));
  EXPECT_FALSE(closest_point(world, {2, 0, 0}, kNaN));
  EXPECT_EQ(closest_point(world, {0, 0, 0}).distance, 1);
}

TEST(ClosestPoint, OfManyByThreads) {
  const Scene s = random_mixture(8, 300);
  const World world(s, {});
  Random random(9);
  std::vector<Float3> points(9000);
  for (Float3& p : points)
    p = random.point(2);
  std::vector<ClosestPoint> found(points.size());
  closest_points(world, points, found, kInf, {.threads = 3});
  for (std::size_t i = 0; i < points.size(); i += 7) {
    const ClosestPoint one = closest_point(world, points[i]);
    EXPECT_EQ(found[i].id, one.id);
    EXPECT_EQ(found[i].distance, one.distance);
    EXPECT_EQ(found[i].point, one.point);
  }
  EXPECT_THROW(closest_points(world, points, std::span(found).first(5)), std::invalid_argument);
}

TEST(SignedDistance, IsNegativeInside) {
  const Scene s = torus_mesh(40, 24, .4);
  const World world(s, {});
  Random random(10);
  std::vector<Float3> points(4000);
  for (Float3& p : points)
    p = random.point(1.6);
  std::vector<float> distances(points.size());
  signed_distances(world, points, distances, {.threads = 2});
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::vector<oracle::Real> all = brute::distances(s, points[i]);
    const auto least = static_cast<double>(*std::min_element(all.begin(), all.end()));
    EXPECT_NEAR(std::abs(distances[i]), least, 2e-6);
    EXPECT_EQ(distances[i] < 0, contains(world, points[i])) << i;
    EXPECT_EQ(signed_distance(world, points[i]), distances[i]);
  }
}

}  // namespace
}  // namespace grelha::test
