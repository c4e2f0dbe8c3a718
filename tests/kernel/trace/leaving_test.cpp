// Rays that leave a surface: none meets the surface it left, and none starts far enough away to
// skip what is near.
#define GRELHA_ISA scalar
#include "kernel/shapes/surface.hpp"
#include "kernel/trace/trace.hpp"

#include "tests/support/oracle.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

struct Tracer {
  const Variant& variant;
  TraceSettings settings;
};

/// Packets of a size, single rays and the reference.
std::vector<Tracer> tracers(int packet) {
  const Variant& best = *find_variant("best");
  return {{best, {.packet = packet}}, {best, {.method = Method::kSingle}}, {reference_walk(), {}}};
}

struct Result {
  std::uint64_t hits = 0, rays = 0, met_again = 0;
  /// largest distance between the surface and where a ray starts, in sizes of the primitive
  double gap = 0;
  std::string first;
  void print(const char* what) const {
    std::printf(
        "%s: %llu hits, %llu rays leave, %llu meet the same primitive again, largest gap %.3g "
        "sizes\n",
        what,
        static_cast<unsigned long long>(hits),
        static_cast<unsigned long long>(rays),
        static_cast<unsigned long long>(met_again),
        gap);
  }
};

/// `make` builds the scene of one primitive of the given size at a place; `convex`: no ray that
/// goes out meets it again; otherwise none at all does, on either side.
template <class Make, class Near>
Result leave_from(
    std::uint64_t seeds, double most_offset, bool convex, const Make& make, const Near& farthest) {
  Result r;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    Random random(seed);
    const double size = random.log_in(1e-12, 1e12),
                 offset = most_offset > 0 ? random.log_in(1e-2, most_offset) : 0;
    const Float3 place = random.point(size * offset);
    const Scene scene = make(random, size, place);
    const World world(scene, {.grid = false});
    const SceneView& view = world.impl().view;
    RayList rays;
    for (int i = 0; i < 16; ++i) {
      const Float3 org = at(place, size * random.log_in(1.5, farthest), random.direction());
      rays.add(org,
               scaled(minus(at(place, size * random.unit(), random.direction()), org),
                      random.log_in(1e-2, 1e2)));
    }
    // Hits as the renderer finds them: what the trace returned, at the origin the trace used.
    RayList leaving;
    std::vector<std::uint32_t> from;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      float org[3] = {rays.ox[i], rays.oy[i], rays.oz[i]};
      const float dir[3] = {rays.dx[i], rays.dy[i], rays.dz[i]};
      scalar::approach(view, org, dir);
      rays.ox[i] = org[0];
      rays.oy[i] = org[1];
      rays.oz[i] = org[2];
    }
    const Answers hits =
        trace(*find_variant("scalar"), world, rays, {Method::kSingle, 1, true}, Query::kClosest);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (hits.id[i] == kNoPrimitive)
        continue;
      ++r.hits;
      const scalar::Vec3<float> org{rays.ox[i], rays.oy[i], rays.oz[i]},
          dir{rays.dx[i], rays.dy[i], rays.dz[i]};
      const scalar::Surface<float> s =
          scalar::surface_of<float>(view.geometry, hits.id[i], org, dir, hits.t[i], false);
      for (int k = 0; k < 16; ++k) {
        Float3 d = random.direction();
        if (k % 4 == 0) {  // along the surface: the worst
          const float n = d.x * s.normal.x + d.y * s.normal.y + d.z * s.normal.z;
          d = at(d, -n * (1 - random.log_in(1e-6, 1e-1)), {s.normal.x, s.normal.y, s.normal.z});
        }
        // So nearly along the surface that rounding decides which side it points to: either answer
        // is right.
        if (std::abs(oracle::dot(d, oracle::unit({s.normal.x, s.normal.y, s.normal.z}))) <
            8 * oracle::kEps)
          continue;
        scalar::Vec3<float> to{d.x, d.y, d.z};
        if (convex && scalar::dot(to, s.normal) < 0) {
          to = scalar::Vec3<float>{0, 0, 0} - to;
          d = {to.x, to.y, to.z};
        }
        const scalar::Vec3<float> start = scalar::leave(s.point, s.normal, s.away, to);
        leaving.add({start.x, start.y, start.z}, d);
        from.push_back(hits.id[i]);
      }
      r.gap =
          std::max(r.gap, 2 * double(s.away) / size);  // the rounding of the start itself included
    }
    r.rays += leaving.size();
    const Answers again =
        trace(*find_variant("scalar"), world, leaving, {Method::kSingle, 1, true}, Query::kClosest);
    for (std::size_t i = 0; i < leaving.size(); ++i) {
      if (again.id[i] != from[i])
        continue;
      if (r.met_again++ == 0)
        r.first = "seed " + std::to_string(seed) + ", size " + std::to_string(size) + ", offset " +
                  std::to_string(offset) + " sizes, t " + show(again.t[i], again.id[i]) + ", " +
                  leaving.describe(i);
    }
  }
  return r;
}

Scene make_sphere(Random&, double size, const Float3& place) {
  return one_sphere(place, static_cast<float>(size));
}
Scene make_plane(Random& random, double, const Float3& place) {
  return one_plane(place, scaled(random.direction(), random.log_in(1e-3, 1e3)));
}
Scene make_triangle(Random& random, double size, const Float3& place) {
  Float3 b = at(place, size, random.direction()),
         c = at(place, size * random.in(.1, 1), random.direction());
  if (random.chance(.2))
    b.y = c.y = place.y;
  return one_triangle(place, b, c);
}
Scene make_cone(Random& random, double size, const Float3& place) {
  const double r0 = size * random.in(.1, 1), r1 = random.chance(.3)   ? r0
                                                  : random.chance(.2) ? 0
                                                                      : size * random.in(0, 1);
  const double height = size * random.in(.3, 2);
  const Float3 other = at(place, height, random.direction());
  if (random.chance(.5))
    return one_cone(other, static_cast<float>(r1), place, static_cast<float>(r0));
  return one_cone(place, static_cast<float>(r0), other, static_cast<float>(r1));
}

struct Row {
  double offset, farthest;
  double gap;  ///< wanted at most, in sizes
};
/// The bounds of surface.hpp in sizes: 16 (sphere) to 64 eps (cone: height up to 2 sizes, radius up
/// to 1, 32 eps of both) and 4 eps of the largest coordinate, which is the offset; doubled as
/// print() does. 2e-5 and 5e-7 offset cover each kind.
constexpr Row kRows[] = {{0, 10, 2e-5},
                         {0, 1e5, 2e-5},
                         {10, 1e3, 3e-5},
                         {1e3, 10, 6e-4},
                         {1e3, 1e5, 6e-4},
                         {1e6, 1e3, .6}};

template <class Make>
void check(const char* name, bool convex, const Make& make) {
  for (const Row& row : kRows) {
    const Result r = leave_from(4000, row.offset, convex, make, row.farthest);
    r.print((std::string(name) + ", offset up to " + std::to_string(row.offset) +
             ", seen from up to " + std::to_string(row.farthest))
                .c_str());
    EXPECT_GT(r.hits, 4000u);
    EXPECT_EQ(r.met_again, 0u) << name << ": " << r.first;
    EXPECT_LT(r.gap, row.gap);
  }
}

TEST(Leaving, Spheres) { check("sphere", true, make_sphere); }
/// Mirror rays about the exact normal, of spheres far from the origin or far larger than what is
/// seen of them. The ray that is met again is the exact one of these very floats as well, so a
/// wrong start or a wrong normal shows, not a wrong test alone.
struct Mirrored {
  std::uint64_t rays = 0, met_again = 0, wrong = 0;
  double normal = 0;  ///< largest distance of a normal from the exact one, in eps
  double away = 0;    ///< largest, less 2^-42 of the radius, in eps of the point
};

template <class Make, class Eye>
Mirrored mirror_off(std::uint64_t seeds, const Make& make, const Eye& eye) {
  Mirrored m;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    Random random(seed);
    const Float3 center = make(random);
    const auto [radius, seen_from, dir] = eye(random, center);
    const Scene scene = one_sphere(center, radius);
    const World world(scene, {.grid = false});
    float moved[3] = {seen_from.x, seen_from.y, seen_from.z};
    const float along[3] = {dir.x, dir.y, dir.z};
    scalar::approach(world.impl().view, moved, along);
    const Float3 org{moved[0], moved[1], moved[2]};
    const oracle::Ball ball{center, radius};
    const auto exact = ball.first({org, dir}, 0);
    RayList ray;
    ray.add(org, dir);
    const TraceSettings single{Method::kSingle, 1, true};
    const Answers hit = trace(*find_variant("scalar"), world, ray, single, Query::kClosest);
    if (hit.id[0] == kNoPrimitive || !exact ||
        oracle::length(oracle::V(org) - ball.center) < ball.radius)
      continue;
    const scalar::Surface<float> s = scalar::surface_of<float>(world.impl().view.geometry,
                                                               0,
                                                               {org.x, org.y, org.z},
                                                               {dir.x, dir.y, dir.z},
                                                               hit.t[0],
                                                               false);
    const oracle::Ray in{org, dir};
    const oracle::V n = oracle::unit(in.point(exact->t) - ball.center);
    const oracle::V off = n - oracle::V(Float3{s.normal.x, s.normal.y, s.normal.z});
    m.normal = std::max(m.normal, static_cast<double>(oracle::length(off) / oracle::kEps));
    m.away = std::max(
        m.away,
        (double(s.away) - 0x1p-42 * radius) / (double(scalar::largest(s.point)) * scalar::kEps));
    const oracle::V out = in.dir - 2 * oracle::dot(n, in.dir) * n;
    const Float3 d{static_cast<float>(out.x), static_cast<float>(out.y), static_cast<float>(out.z)};
    const scalar::Vec3<float> start = scalar::leave(s.point, s.normal, s.away, {d.x, d.y, d.z});
    const Float3 from{start.x, start.y, start.z};
    RayList leaving;
    leaving.add(from, d);
    const Answers again = trace(*find_variant("scalar"), world, leaving, single, Query::kClosest);
    ++m.rays;
    m.met_again += again.id[0] != kNoPrimitive;
    m.wrong += (again.id[0] != kNoPrimitive) != ball.first({from, d}, 0).has_value();
  }
  return m;
}

struct Seen {
  float radius;
  Float3 org, dir;
};

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

TEST(Leaving, Planes) {
  // A plane's error is that of the point met, which grows with the distance of the origin.
  for (const Row& row : kRows) {
    const Result r = leave_from(4000, row.offset, false, make_plane, row.farthest);
    r.print(("plane, offset up to " + std::to_string(row.offset) + ", seen from up to " +
             std::to_string(row.farthest))
                .c_str());
    EXPECT_GT(r.hits, 4000u);
    EXPECT_EQ(r.met_again, 0u) << r.first;
  }
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
    const SceneView& view = world.impl().view;
    RayList rays;
    for (int i = 0; i < 64; ++i) {
      const Float3 eye = random.point(2), to = random.direction();
      const scalar::Vec3<float> org{eye.x, eye.y, eye.z}, dir{to.x, to.y, to.z};
      const scalar::Surface<float> s = scalar::surface_of<float>(
          view.geometry, 0, org, dir, static_cast<float>(random.in(.1, 1)), false);
      scalar::Vec3<float> away{to.x, to.y, to.z};
      if (scalar::dot(away, s.normal) < 0)
        away = scalar::Vec3<float>{0, 0, 0} - away;
      const scalar::Vec3<float> start = scalar::leave(s.point, s.normal, s.away, away);
      rays.add({start.x, start.y, start.z}, {away.x, away.y, away.z});
    }
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

/// A ball of radius 20 half sunk into a plane, from up to 10^8 away, where t in single precision is
/// off by up to 10. Rays go through the ball where it stands at least 1 above the plane.
TEST(FarEyes, SeeWhatStandsOnAPlane) {
  Scene scene = one_plane({0, 0, 0}, {.05f, .1f, 1});
  scene.geometry.spheres.add({0, 0, 0}, 20, 0);
  for (const bool grid : {true, false}) {
    const World world(scene, {.grid = grid});
    Random random(1);
    RayList rays;
    while (rays.size() < 2000) {
      const auto far = [&](double lo, double hi) {
        return 8 * std::floor(static_cast<float>(random.in(lo, hi)) / 8);
      };  // whole ulps: what follows is exact
      const Float3 eye{far(-1e8, 1e8), far(-1e8, 1e8), far(2e7, 1e8)};
      const Float3 target{8.f * static_cast<float>(random.below(3)) - 8,
                          8.f * static_cast<float>(random.below(3)) - 8,
                          8.f * static_cast<float>(random.below(2))};
      const Float3 dir = minus(target, eye);
      const double n = std::sqrt(double(dir.x) * dir.x + double(dir.y) * dir.y +
                                 double(dir.z) * dir.z),
                   u[3] = {dir.x / n, dir.y / n, dir.z / n};
      const double b = target.x * u[0] + target.y * u[1] + target.z * u[2];
      const double back = b + std::sqrt(b * b + 400 -
                                        (double(target.x) * target.x + double(target.y) * target.y +
                                         double(target.z) * target.z));
      const double hit[3] = {
          target.x - back * u[0], target.y - back * u[1], target.z - back * u[2]};
      if (.05 * hit[0] + .1 * hit[1] + hit[2] > 1)
        rays.add(eye, dir);
    }
    for (const Tracer& tracer : tracers(64)) {
      const Answers a = trace(tracer.variant, world, rays, tracer.settings, Query::kClosest);
      for (std::size_t i = 0; i < rays.size(); ++i)
        EXPECT_EQ(a.id[i], 1u) << rays.describe(i);
    }
  }
}

TEST(Leaving, Triangles) { check("triangle", false, make_triangle); }
TEST(Leaving, Cones) { check("cone", true, make_cone); }

/// Where a cone has no radius all directions across its axis are as good, and a normal must be one
/// of them.
TEST(ConeSurface, HasANormalOnItsTip) {
  for (const bool tip_first : {false, true}) {
    const Float3 tip{0, 2, 0}, foot{0, 0, 0};
    const Scene scene = tip_first ? one_cone(tip, 0, foot, 1) : one_cone(foot, 1, tip, 0);
    const World world(scene, {.grid = false});
    const scalar::Surface<float> s =
        scalar::surface_of<float>(world.impl().view.geometry, 0, {0, 2, 5}, {0, 0, -1}, 5, false);
    EXPECT_NEAR(scalar::length(s.normal), 1, 4 * 0x1p-24);
    EXPECT_NEAR(s.normal.y, 1 / std::sqrt(5.), 4 * 0x1p-24);
    EXPECT_EQ(s.point.y, 2);
  }
}

/// Rays sent inwards cross the body: what they meet is its far side, not the place they left.
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
    const Answers hit =
        trace(*find_variant("scalar"), world, rays, {Method::kSingle, 1, true}, Query::kClosest);
    if (hit.id[0] == kNoPrimitive)
      continue;
    const scalar::Vec3<float> org{eye.x, eye.y, eye.z}, dir{rays.dx[0], rays.dy[0], rays.dz[0]};
    const scalar::Surface<float> s =
        scalar::surface_of<float>(world.impl().view.geometry, 0, org, dir, hit.t[0], false);
    Float3 d = random.direction();
    float cosine = d.x * s.normal.x + d.y * s.normal.y + d.z * s.normal.z;
    if (cosine > 0) {
      d = scaled(d, -1);
      cosine = -cosine;
    }
    if (cosine > -.05f)
      continue;
    const scalar::Vec3<float> start = scalar::leave(s.point, s.normal, s.away, {d.x, d.y, d.z});
    RayList inwards;
    inwards.add({start.x, start.y, start.z}, d);
    const Answers far =
        trace(*find_variant("scalar"), world, inwards, {Method::kSingle, 1, true}, Query::kClosest);
    ASSERT_EQ(far.id[0], 0u) << "seed " << seed;
    // The chord is -2 r cosine. The start stands off by `away` and its rounding, which the chord
    // feels by 1 / |cosine|.
    EXPECT_NEAR(far.t[0], -2 * size * cosine, 4 * s.away / -cosine + 1e-5 * size)
        << "seed " << seed;
    ++judged;
  }
  EXPECT_GT(judged, 10000u);
}

/// Something a thousandth of the size above a surface is met, not skipped, wherever that is far
/// above the spacing of floats.
TEST(Leaving, SeesWhatIsNear) {
  std::uint64_t rays = 0;
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    Random random(seed);
    const double size = random.log_in(1e-12, 1e12);
    const Float3 place = random.point(size * random.log_in(1e-2, 100));
    const float gap = static_cast<float>(1e-3 * size);
    Scene scene = empty_scene();
    for (const float up : {0.f, gap}) {
      const float y = place.y + up;
      add_triangle(scene,
                   {place.x - float(size), y, place.z - float(size)},
                   {place.x + float(size), y, place.z - float(size)},
                   {place.x, y, place.z + float(size)});
    }
    const World world(scene, {.grid = false});
    const scalar::Vec3<float> org{place.x, place.y + gap / 2, place.z}, dir{0, -1, 0};
    const scalar::Surface<float> s =
        scalar::surface_of<float>(world.impl().view.geometry, 0, org, dir, gap / 2, false);
    Float3 d = random.direction();
    if (d.y < 0)
      d = scaled(d, -1);
    if (d.y < .1f)
      continue;
    const scalar::Vec3<float> start = scalar::leave(s.point, s.normal, s.away, {d.x, d.y, d.z});
    RayList up;
    up.add({start.x, start.y, start.z}, d);
    EXPECT_EQ(trace(*find_variant("scalar"), world, up, {Method::kSingle, 1, true}, Query::kClosest)
                  .id[0],
              1u)
        << "seed " << seed;
    ++rays;
  }
  EXPECT_GT(rays, 15000u);
}

}  // namespace
}  // namespace grelha::test
