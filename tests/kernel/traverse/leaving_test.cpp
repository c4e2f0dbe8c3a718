// Rays that leave a surface, of every kind, size and place: none hits the surface it left.
#include "tests/kernel/traverse/leaving.hpp"

#include <optional>

namespace grelha::test {
namespace {

struct Result {
  std::uint64_t hits = 0, rays = 0, met_again = 0;
  /// largest distance between the surface and where a ray starts, in sizes of the primitive
  double gap = 0;
  std::string first;
  void print(const std::string& what) const {
    std::printf(
        "%s: %llu hits, %llu rays leave, %llu meet the same primitive again, largest gap %.3g "
        "sizes\n",
        what.c_str(),
        static_cast<unsigned long long>(hits),
        static_cast<unsigned long long>(rays),
        static_cast<unsigned long long>(met_again),
        gap);
  }
};

/// Primitives of any size up to `offset` sizes from the origin, seen from up to `farthest` sizes
/// away.
struct Row {
  double offset, farthest;
  double gap;  ///< wanted at most, in sizes
  std::string name() const {
    return ", offset up to " + std::to_string(offset) + ", seen from up to " +
           std::to_string(farthest);
  }
};

/// Rays to a primitive from all around.
RayList rays_to(Random& random, const Float3& place, double size, double farthest) {
  RayList rays;
  for (int i = 0; i < 16; ++i) {
    const Float3 org = at(place, size * random.log_in(1.5, farthest), random.direction());
    rays.add(org,
             scaled(minus(at(place, size * random.unit(), random.direction()), org),
                    random.log_in(1e-2, 1e2)));
  }
  return rays;
}

/// A direction, every fourth along the surface: the worst. None where it runs so nearly along it
/// that rounding decides which side it points to: either answer is right.
std::optional<Float3> way_out(Random& random, const Surface& s, bool along, bool outwards) {
  Float3 d = random.direction();
  if (along) {
    const float n = d.x * s.normal.x + d.y * s.normal.y + d.z * s.normal.z;
    d = at(d, -n * (1 - random.log_in(1e-6, 1e-1)), floats(s.normal));
  }
  if (std::abs(oracle::dot(d, oracle::unit(floats(s.normal)))) < 8 * oracle::kEps)
    return std::nullopt;
  const V to = vec(d);
  return outwards && scalar::dot(to, s.normal) < 0 ? floats(V{0, 0, 0} - to) : d;
}

/// Rays that leave what others hit, and the primitives they leave.
struct Leaving {
  RayList rays;
  std::vector<std::uint32_t> from;
};

/// From hits as the renderer finds them: what the trace returned, at the origin the trace used.
Leaving rays_from_hits(
    Random& random, const World& world, const RayList& rays, double size, bool convex, Result& r) {
  Leaving leaving;
  const Answers hits = scalar_hits(world, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (hits.id[i] == kNoPrimitive)
      continue;
    ++r.hits;
    const Surface s = surface_at(world, hits.id[i], rays.org(i), rays.dir(i), hits.t[i]);
    for (int k = 0; k < 16; ++k)
      if (const auto d = way_out(random, s, k % 4 == 0, convex)) {
        leaving.rays.add(start_of(s, *d), *d);
        leaving.from.push_back(hits.id[i]);
      }
    r.gap =
        std::max(r.gap, 2 * double(s.offset) / size);  // the rounding of the start itself included
  }
  return leaving;
}

/// `make` builds the scene of one primitive of the given size at a place; `convex`: no ray that
/// goes out hits it again; otherwise none at all does, on either side.
template <class Make>
Result leave_from(std::uint64_t seeds, const Row& row, bool convex, const Make& make) {
  Result r;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    Random random(seed);
    const double size = random.log_in(1e-12, 1e12);
    const double offset = row.offset > 0 ? random.log_in(1e-2, row.offset) : 0;
    const Float3 place = random.point(size * offset);
    const Scene scene = make(random, size, place);
    const World world(scene, {.grid = false});
    const RayList rays = rays_to(random, place, size, row.farthest);
    const Leaving leaving = rays_from_hits(random, world, rays, size, convex, r);
    r.rays += leaving.rays.size();
    const Answers again = scalar_hits(world, leaving.rays);
    for (std::size_t i = 0; i < leaving.rays.size(); ++i) {
      if (again.id[i] != leaving.from[i])
        continue;
      if (r.met_again++ == 0)
        r.first = "seed " + std::to_string(seed) + ", size " + std::to_string(size) + ", offset " +
                  std::to_string(offset) + " sizes, t " + show(again.t[i], again.id[i]) + ", " +
                  leaving.rays.describe(i);
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
void check(const std::string& name, bool convex, const Make& make) {
  for (const Row& row : kRows) {
    const Result r = leave_from(4000, row, convex, make);
    r.print(name + row.name());
    EXPECT_GT(r.hits, 4000u);
    EXPECT_EQ(r.met_again, 0u) << name << ": " << r.first;
    EXPECT_LT(r.gap, row.gap);
  }
}

TEST(Leaving, Spheres) {
  check("sphere", true, make_sphere);
}
TEST(Leaving, Triangles) {
  check("triangle", false, make_triangle);
}
TEST(Leaving, Cones) {
  check("cone", true, make_cone);
}

TEST(Leaving, Planes) {
  // A plane's error is that of the point hit, which grows with the distance of the origin.
  for (const Row& row : kRows) {
    const Result r = leave_from(4000, row, false, make_plane);
    r.print("plane" + row.name());
    EXPECT_GT(r.hits, 4000u);
    EXPECT_EQ(r.met_again, 0u) << r.first;
  }
}

/// At the tip of a cone the radius is zero, so any direction across the axis is valid. The normal
/// must be the one for such a direction.
TEST(ConeSurface, HasANormalOnItsTip) {
  for (const bool tip_first : {false, true}) {
    const Float3 tip{0, 2, 0}, foot{0, 0, 0};
    const Scene scene = tip_first ? one_cone(tip, 0, foot, 1) : one_cone(foot, 1, tip, 0);
    const World world(scene, {.grid = false});
    const Surface s = surface_at(world, 0, {0, 2, 5}, {0, 0, -1}, 5);
    EXPECT_NEAR(scalar::length(s.normal), 1, 4 * 0x1p-24);
    EXPECT_NEAR(s.normal.y, 1 / std::sqrt(5.), 4 * 0x1p-24);
    EXPECT_EQ(s.point.y, 2);
  }
}

}  // namespace
}  // namespace grelha::test
