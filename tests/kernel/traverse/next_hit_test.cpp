// Tests the hits of rays that leave a surface, or come from far away: near surfaces are not
// skipped, and the surface that a ray left is not hit again.
#include "tests/kernel/traverse/leaving.hpp"

namespace grelha::test {
namespace {

struct Tracer {
  const Variant& variant;
  TraceOptions settings;
};

/// Packets of a size, single rays and the reference.
std::vector<Tracer> tracers(int packet) {
  const Variant& best = *find_variant("best");
  return {{best, {.packet = packet}}, {best, {.packet = 1}}, {reference_walk(), {}}};
}

/// Rays that leave primitive 0 where others hit it, from anywhere and at any t.
RayList rays_off_a_plane(Random& random, const World& world) {
  RayList rays;
  for (int i = 0; i < 64; ++i) {
    const Float3 eye = random.point(2);
    const Float3 to = random.direction();
    const Surface s = surface_at(world, 0, eye, to, static_cast<float>(random.in(.1, 1)));
    const Float3 away = scalar::dot(vec(to), s.normal) < 0 ? floats(V{0, 0, 0} - vec(to)) : to;
    rays.add(start_of(s, away), away);
  }
  return rays;
}

/// A speck far from where rays leave a plane: they are moved near it before grids are walked, and
/// must not find the plane on the way.
TEST(Leaving, PlanesWithAllElseFarAway) {
  int left = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    Scene scene = one_plane(random.point(1), random.direction());
    const Float3 far = at({0, 0, 0}, random.log_in(1e2, 1e4), random.direction());
    scene.geometry.spheres.add(far, static_cast<float>(random.log_in(1e-4, 1e-1)), 0);
    const World world(scene, {});
    const RayList rays = rays_off_a_plane(random, world);
    for (const Tracer& tracer : tracers(16))
      for (const Query query : {Query::kClosest, Query::kOccluded}) {
        const Answers a = trace(tracer.variant, world, rays, tracer.settings, query);
        for (std::size_t i = 0; i < rays.size(); ++i) {
          ++left;
          EXPECT_NE(a.id[i], 0u) << rays.describe(i);
        }
      }
  }
  EXPECT_EQ(left, 200 * 64 * 6);
}

/// How far above the plane of FarEyes a ray hits the ball, times the length of the plane's normal.
/// The ray goes along the unit direction u, through a place within.
double height_of_hit(const Float3& place, const double (&u)[3]) {
  const double b = place.x * u[0] + place.y * u[1] + place.z * u[2];
  const double back = b + std::sqrt(b * b + 400 -
                                    (double(place.x) * place.x + double(place.y) * place.y +
                                     double(place.z) * place.z));
  const double hit[3] = {place.x - back * u[0], place.y - back * u[1], place.z - back * u[2]};
  return .05 * hit[0] + .1 * hit[1] + hit[2];
}

RayList rays_from_afar() {
  Random random(1);
  const auto far = [&](double lo, double hi) {
    return 8 * std::floor(static_cast<float>(random.in(lo, hi)) / 8);
  };  // whole ulps: what follows is exact
  RayList rays;
  while (rays.size() < 2000) {
    const Float3 eye{far(-1e8, 1e8), far(-1e8, 1e8), far(2e7, 1e8)};
    const Float3 target{8.f * static_cast<float>(random.below(3)) - 8,
                        8.f * static_cast<float>(random.below(3)) - 8,
                        8.f * static_cast<float>(random.below(2))};
    const Float3 dir = minus(target, eye);
    const double n =
        std::sqrt(double(dir.x) * dir.x + double(dir.y) * dir.y + double(dir.z) * dir.z);
    if (height_of_hit(target, {dir.x / n, dir.y / n, dir.z / n}) > 1)
      rays.add(eye, dir);
  }
  return rays;
}

/// A ball of radius 20 half sunk into a plane, from up to 10^8 away, where t in single precision is
/// off by up to 10. RayList go through the ball where it stands at least 1 above the plane.
TEST(FarEyes, SeeWhatStandsOnAPlane) {
  Scene scene = one_plane({0, 0, 0}, {.05f, .1f, 1});
  scene.geometry.spheres.add({0, 0, 0}, 20, 0);
  for (const bool grid : {true, false}) {
    const World world(scene, {.grid = grid});
    const RayList rays = rays_from_afar();
    for (const Tracer& tracer : tracers(64)) {
      const Answers a = trace(tracer.variant, world, rays, tracer.settings, Query::kClosest);
      for (std::size_t i = 0; i < rays.size(); ++i)
        EXPECT_EQ(a.id[i], 1u) << rays.describe(i);
    }
  }
}

/// Rays sent inwards cross the body: what they hit is its far side, not the place they left.
TEST(Leaving, InwardsMeetsTheFarSide) {
  std::uint64_t judged = 0;
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    Random random(seed);
    const double size = random.log_in(1e-12, 1e12);
    const Float3 center = random.point(size * random.log_in(1e-2, 1e3));
    const Scene scene = one_sphere(center, static_cast<float>(size));
    const World world(scene, {.grid = false});
    const Float3 eye = at(center, size * random.log_in(1.5, 100), random.direction());
    RayList rays;
    rays.add(eye, minus(at(center, .9 * size, random.direction()), eye));
    const Answers hit = scalar_hits(world, rays);
    if (hit.id[0] == kNoPrimitive)
      continue;
    const Surface s = surface_at(world, 0, eye, rays.dir(0), hit.t[0]);
    Float3 d = random.direction();
    float cosine = d.x * s.normal.x + d.y * s.normal.y + d.z * s.normal.z;
    if (cosine > 0) {
      d = scaled(d, -1);
      cosine = -cosine;
    }
    if (cosine > -.05f)
      continue;
    RayList inwards;
    inwards.add(start_of(s, d), d);
    const Answers far = scalar_hits(world, inwards);
    ASSERT_EQ(far.id[0], 0u) << "seed " << seed;
    // The chord is -2 r cosine. The start stands off by `away` and its rounding, which the chord
    // feels by 1 / |cosine|.
    EXPECT_NEAR(far.t[0], -2 * size * cosine, 4 * s.offset / -cosine + 1e-5 * size)
        << "seed " << seed;
    ++judged;
  }
  EXPECT_GT(judged, 10000u);
}

/// A triangle of that size, and another above it.
Scene two_floors(const Float3& place, float size, float gap) {
  Scene scene = empty_scene();
  for (const float up : {0.f, gap}) {
    const float y = place.y + up;
    add_triangle(scene,
                 {place.x - size, y, place.z - size},
                 {place.x + size, y, place.z - size},
                 {place.x, y, place.z + size});
  }
  return scene;
}

/// Something a thousandth of the size above a surface is hit, not skipped, wherever that is far
/// above the spacing of floats.
TEST(Leaving, SeesWhatIsNear) {
  std::uint64_t rays = 0;
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    Random random(seed);
    const double size = random.log_in(1e-12, 1e12);
    const Float3 place = random.point(size * random.log_in(1e-2, 100));
    const float gap = static_cast<float>(1e-3 * size);
    const Scene scene = two_floors(place, static_cast<float>(size), gap);
    const World world(scene, {.grid = false});
    const Surface s =
        surface_at(world, 0, {place.x, place.y + gap / 2, place.z}, {0, -1, 0}, gap / 2);
    Float3 d = random.direction();
    if (d.y < 0)
      d = scaled(d, -1);
    if (d.y < .1f)
      continue;
    RayList up;
    up.add(start_of(s, d), d);
    EXPECT_EQ(scalar_hits(world, up).id[0], 1u) << "seed " << seed;
    ++rays;
  }
  EXPECT_GT(rays, 15000u);
}

}  // namespace
}  // namespace grelha::test
