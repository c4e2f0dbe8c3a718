// Closest points and signed distances, against every primitive in long double.
#include "grelha/all_hits.hpp"
#include "grelha/distance.hpp"
#include "grelha/isa.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "kernel/world/world_impl.hpp"
#include "kernel/shapes/foot.hpp"
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

/// Looks at every primitive, in doubles as the search does.
ClosestPoint nearest_of_all(const World& world, const Float3& p) {
  const World::Impl& w = world.impl();
  const double at[3] = {p.x, p.y, p.z};
  Foot least{{}, kInf};
  std::uint32_t id = kNoPrimitive;
  for (std::uint32_t i = 0; i < w.primitives.ids.end(); ++i) {
    const Foot foot = foot_on(w.view.geometry, i, at);
    if (foot.distance < least.distance) {
      least = foot;
      id = i;
    }
  }
  const auto narrow = [&](int a) { return static_cast<float>(least.at[a]); };
  return {{narrow(0), narrow(1), narrow(2)}, static_cast<float>(least.distance), id};
}

/// The box of all primitives.
struct SceneBox {
  double middle[3], size = 0;

  explicit SceneBox(const World& world) {
    const SceneView& view = world.impl().view;
    for (int a = 0; a < 3; ++a) {
      middle[a] = .5 * (view.box_lo[a] + view.box_hi[a]);
      size = std::max(size, double{view.box_hi[a]} - view.box_lo[a]);
    }
  }
  Float3 from_middle(const Float3& way, double sizes) const {
    return {static_cast<float>(middle[0] + sizes * size * way.x),
            static_cast<float>(middle[1] + sizes * size * way.y),
            static_cast<float>(middle[2] + sizes * size * way.z)};
  }
};

/// The scenes of kAlike primitives are as far from 0 or from kFar, about: their distances differ in
/// the last places of floats.
constexpr Float3 kFar{6e3f, 6e3f, 6e3f};
constexpr int kAlike = 400;

/// In the surface, beside it, in the middle, around and far away.
std::vector<Float3> points_everywhere(const World& world, const Scene& s, int each) {
  Random random(21);
  const SceneBox box(world);
  std::vector<Float3> points{{}, kFar};
  const Triangles& t = s.geometry.triangles;
  for (int i = 0; i < each && t.size() > 0; ++i) {
    const std::uint32_t one = random.below(static_cast<std::uint32_t>(t.size()));
    const Float3 corner = vertex(s, t.a[one]);
    const Float3 edge = at(corner, random.unit(), minus(vertex(s, t.b[one]), corner));
    const Float3 inside = at(edge, random.unit(), minus(vertex(s, t.c[one]), edge));
    for (const Float3& p : {corner, edge, inside})
      points.push_back(p);
    points.push_back(at(inside, .01 * box.size, random.direction()));
  }
  for (const double sizes : {0., 1e-6, .5, 1., 10., 300., 1e4, 1e9})
    for (int i = 0; i < each; ++i)
      points.push_back(box.from_middle(random.direction(), sizes));
  return points;
}

Scene moved(Scene s, double x, double y, double z) {
  Triangles& t = s.geometry.triangles;
  for (std::size_t i = 0; i < t.x.size(); ++i) {
    t.x[i] = static_cast<float>(t.x[i] + x);
    t.y[i] = static_cast<float>(t.y[i] + y);
    t.z[i] = static_cast<float>(t.z[i] + z);
  }
  return s;
}

/// Triangles whose nearest point is a corner of their boxes.
Scene corners_around(std::uint64_t seed) {
  Random random(seed);
  Scene s = empty_scene();
  for (int i = 0; i < kAlike; ++i) {
    const Float3 p = at({}, 10, random.direction());
    add_triangle(s,
                 p,
                 {p.x + std::copysign(.5f, p.x), p.y, p.z + std::copysign(.2f, p.z)},
                 {p.x, p.y + std::copysign(.5f, p.y), p.z});
  }
  return s;
}
/// The same of a sheet, seen from afar.
Scene corners_afar(std::uint64_t seed) {
  Random random(seed);
  Scene s = empty_scene();
  for (int i = 0; i < kAlike; ++i) {
    const double x = random.in(-1, 1), y = random.in(-1, 1);
    const double far = kFar.x;
    const double across = (far - x) * (far - x) + (far - y) * (far - y);
    const double z = far - std::sqrt(3 * far * far - across);
    const Float3 p{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
    add_triangle(s, p, {p.x - .1f, p.y, p.z - .02f}, {p.x, p.y - .1f, p.z});
  }
  return s;
}
/// Balls and flat tubes that hold 0, close below their surface.
Scene balls_around(std::uint64_t seed) {
  Random random(seed);
  Scene s = empty_scene();
  for (int i = 0; i < kAlike; ++i)
    s.geometry.spheres.add(at({}, 10, random.direction()), 10.01f, 0);
  return s;
}
Scene tubes_around(std::uint64_t seed) {
  Random random(seed);
  Scene s = empty_scene();
  for (int i = 0; i < kAlike; ++i) {
    const Float3 axis = random.direction();
    const Float3 way = cross(axis, random.direction());
    const double length = std::hypot(way.x, way.y, way.z);
    const Float3 across = at({}, 100 / length, way);
    s.geometry.cones.add(at(across, -.01, axis), 100.01f, at(across, .01, axis), 100.01f, 0);
  }
  return s;
}

std::vector<Scene> all_sorts() {
  std::vector<Scene> all{ball_mesh(60, 30),
                         ball_mesh(40, 20, .2),
                         moved(ball_mesh(60, 30), 1000, -3, 70000),
                         torus_mesh(30, 20, .3),
                         needles(4, 600),
                         random_triangles(2, 900),
                         random_mixture(8, 900),
                         random_cones(6, 500),
                         stacked_sheets(60),
                         mesh_in_a_vast_scene()};
  for (std::uint64_t seed = 1; seed <= 8; ++seed)
    for (const auto& make : {corners_around, corners_afar, balls_around, tubes_around})
      all.push_back(make(seed));
  all.push_back(random_mixture(9, 300));
  all.back().geometry.planes.add({0, -1.5f, 0}, {.2f, 2, .1f}, 0);
  return all;
}

/// The search leaves out what cannot be nearest, and nothing else: no bound of a box or a primitive
/// is above what doubles find, and of equal distance the lower id counts.
TEST(ClosestPoint, HasTheBitsOfASearchWithoutBounds) {
  const std::vector<Scene> scenes = all_sorts();
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    const World world(scenes[k], {});
    const std::vector<Float3> points = points_everywhere(world, scenes[k], 40);
    std::vector<ClosestPoint> truth(points.size()), found(points.size());
    std::transform(points.begin(), points.end(), truth.begin(), [&](const Float3& p) {
      return nearest_of_all(world, p);
    });
    for (const Isa& isa : isas()) {
      if (!isa.is_supported)
        continue;
      closest_points(world, points, found, kInf, {.isa = isa.name});
      for (std::size_t i = 0; i < points.size(); ++i) {
        ASSERT_EQ(found[i].id, truth[i].id) << isa.name << ", scene " << k << ", point " << i;
        ASSERT_EQ(found[i].distance, truth[i].distance);
        ASSERT_EQ(found[i].point, truth[i].point);
      }
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

TEST(ClosestPoint, OfEqualDistanceIsTheOneWithTheLowerId) {
  Scene s = empty_scene();
  for (const float x : {3.f, 1.f, -1.f, 1.f})  // each as far from 0 as its neighbours
    add_triangle(s, {x, -1, -1}, {x, 1, -1}, {x, 0, 1});
  const World world(s, {});
  const World without_grid(s, {.grid = false});
  EXPECT_EQ(closest_point(world, {0, 0, 0}).id, 1u);
  EXPECT_EQ(closest_point(without_grid, {0, 0, 0}).id, 1u);
  EXPECT_EQ(closest_point(world, {2, 0, 0}).id, 0u);
}

TEST(ClosestPoint, WithinARadiusOfZeroLiesOnTheSurface) {
  const Scene s = torus_mesh(20, 12, .4);
  const World world(s, {});
  const Float3 corner{
      s.geometry.triangles.x[7], s.geometry.triangles.y[7], s.geometry.triangles.z[7]};
  const ClosestPoint found = closest_point(world, corner, 0);
  EXPECT_TRUE(found);
  EXPECT_EQ(found.distance, 0);
  EXPECT_FALSE(closest_point(world, {corner.x * 1.001f, corner.y, corner.z}, 0));
}

/// Where the point before found nothing, the next one is looked for as if it were the first.
TEST(ClosestPoint, AfterAPointWithoutOne) {
  Scene s = one_triangle({-2, -2, .5f}, {2, -2, .5f}, {-2, 2, .5f});
  for (int i = 0; i < 20; ++i)
    s.geometry.spheres.add({-1.5f + .1f * static_cast<float>(i), -1.5f, 3}, .01f, 0);
  const World world(s, {});
  Random random(6);
  std::vector<Float3> points;
  for (int i = 0; i < 400; ++i)
    points.push_back(random.chance(.5) ? random.point(40) : random.point(2));
  std::vector<ClosestPoint> found(points.size());
  closest_points(world, points, found, 1, {.threads = 1});
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ClosestPoint alone = closest_point(world, points[i], 1);
    EXPECT_EQ(found[i].id, alone.id);
    EXPECT_EQ(found[i].distance, alone.distance);
  }
}

TEST(ClosestPoint, OfSliversIsTheirs) {
  Random random(12);
  for (int i = 0; i < 20000; ++i) {
    // as wide as floats of the long edge are apart
    const Float3 a = random.point(1);
    const Float3 b = random.point(1);
    const Float3 c =
        at(at(a, random.unit(), minus(b, a)), random.log_in(1e-8, 1e-3), random.direction());
    Scene s = empty_scene();
    add_triangle(s, a, b, c);
    const World world(s, {});
    for (const Float3& corner : {a, b, c})
      ASSERT_EQ(closest_point(world, corner).distance, 0) << i;
    // close to the middle, so that the float of the distance is no coarser than doubles of its foot
    const Float3 p = at(at(a, .45, minus(b, a)), random.log_in(1e-8, 1e-6), random.direction());
    const std::vector<oracle::Real> truth = brute::distances(s, p);
    ASSERT_NEAR(closest_point(world, p).distance, static_cast<double>(truth[0]), 1e-12) << i;
  }
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

/// All triangles are equally near to the middle of a ball, so each of these points takes long.
TEST(ClosestPoint, AsksWhetherToGoOnWhatOnePointCosts) {
  const Scene s = ball_mesh(200, 100);
  const World world(s, {});
  const std::vector<Float3> points(40);
  std::vector<ClosestPoint> found(points.size());
  std::vector<float> distances(points.size());
  int calls = 0;
  const QueryOptions options{.progress = [&](double) { return ++calls % 3 != 0; }};
  EXPECT_THROW(closest_points(world, points, found, kInf, options), Stopped);
  EXPECT_EQ(calls, 3);
  EXPECT_FALSE(found.back()) << "what comes after is not done";
  EXPECT_THROW(signed_distances(world, points, distances, options), Stopped);
  EXPECT_EQ(calls, 6);
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

TEST(SignedDistance, OnTheSurfaceIsZeroWithoutASign) {
  const Scene s = torus_mesh(20, 12, .4);
  const World world(s, {});
  int inside = 0;
  for (std::size_t i = 0; i < s.geometry.triangles.x.size(); ++i) {
    const Float3 p{s.geometry.triangles.x[i], s.geometry.triangles.y[i], s.geometry.triangles.z[i]};
    inside += contains(world, p);
    EXPECT_EQ(signed_distance(world, p), 0);
    EXPECT_FALSE(std::signbit(signed_distance(world, p)));
  }
  EXPECT_GT(inside, 0);
}

TEST(SignedDistance, OfBallsIsNegativeInsideAny) {
  Scene s = empty_scene();
  s.geometry.spheres.add({0, 0, 0}, 2, 0);
  s.geometry.spheres.add({1, 0, 0}, 2, 0);
  s.geometry.spheres.add({9, 0, 0}, -1, 0);
  for (int i = 0; i < 60; ++i)
    s.geometry.spheres.add({20 + .1f * static_cast<float>(i), 5, 0}, .3f, 0);
  const World world(s, {});
  for (const float x : {-1.5f, .5f, 2.5f, 8.5f})
    EXPECT_LT(signed_distance(world, {x, 0, 0}), 0) << x;
  for (const float x : {-2.5f, 3.5f, 7.5f, 10.5f})
    EXPECT_GT(signed_distance(world, {x, 0, 0}), 0) << x;
  EXPECT_LT(signed_distance(world, {20, 5, 0}), 0);
  EXPECT_GT(signed_distance(world, {20, 6, 0}), 0);
}

}  // namespace
}  // namespace grelha::test
