// Rays that leave a large surface where it passes the origin: there the point is as precise as its
// own small size, and what the surface's size takes of it shows.
#include "tests/kernel/traverse/leaving.hpp"

namespace grelha::test {
namespace {

/// Traces a ray through `to`, and from its hit a second ray in direction `dir`, or -`dir` if that
/// is the side that the first ray came from. Returns true if the second ray hits something; sets
/// `left` to false if the first ray misses.
bool met_again(const World& world, const Float3& org, const Float3& to, Float3 dir, bool& left) {
  RayList in;
  in.add(org, minus(to, org));
  const Answers hit = scalar_hits(world, in);
  left = hit.id[0] != kNoPrimitive;
  if (!left)
    return false;
  const Surface s = surface_at(world, hit.id[0], org, minus(to, org), hit.t[0]);
  // to the side that the ray came from
  const bool towards = dot(s.normal, vec(minus(org, to))) > 0;
  if ((dot(s.normal, vec(dir)) > 0) != towards)
    dir = scaled(dir, -1);
  RayList out;
  out.add(start_of(s, dir), dir);
  return scalar_hits(world, out).id[0] != kNoPrimitive;
}

/// Directions along the surface, as far as floats can say: they sink towards what bulges.
TEST(Leaving, RaysAlongLargeSpheresAtTheOrigin) {
  int left = 0;
  int again = 0;
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    Random random(seed);
    const Float3 up = random.direction();
    const double size = random.log_in(1e3, 1e6);
    const Float3 center = at({0, 0, 0}, -size, up);
    const oracle::V c(center);
    const float radius = static_cast<float>(oracle::length(c));
    const Scene scene = one_sphere(center, radius);
    const World world(scene, {.grid = false});
    // across the direction to the middle, which is the normal but for what floats take from it
    const oracle::V some(random.direction());
    const oracle::V across = oracle::unit(some - (oracle::dot(some, c) / oracle::dot(c, c)) * c);
    const Float3 dir{
        static_cast<float>(across.x), static_cast<float>(across.y), static_cast<float>(across.z)};
    bool hit = false;
    again += met_again(world, at({0, 0, 0}, size * 1e-3, up), {0, 0, 0}, dir, hit);
    left += hit;
  }
  EXPECT_GT(left, 15000);
  EXPECT_EQ(again, 0);
}

/// Triangles around the origin whose plane holds it exactly: what double takes of their corners is
/// more than a last place of points there.
TEST(Leaving, RaysOfLargeTrianglesAtTheOrigin) {
  int left = 0;
  int again = 0;
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    Random random(seed);
    const auto whole = [&] { return static_cast<float>(random.below(2001)) - 1000; };
    const float size = static_cast<float>(random.log_in(1e-3, 1e3));
    Float3 a;
    Float3 b;
    Float3 c;
    for (std::uint32_t k = 0; k < 3; ++k) {
      component(a, k) = whole();
      component(b, k) = whole();
      component(c, k) = -(component(a, k) + component(b, k));
    }
    const Scene scene = one_triangle(a, b, c);
    const World world(scene, {.grid = false});
    const Float3 org = random.point(1000);
    const Float3 to = random.point(static_cast<double>(size) * 1e-9);
    bool hit = false;
    again += met_again(world, org, to, random.direction(), hit);
    left += hit;
  }
  EXPECT_GT(left, 15000);
  EXPECT_EQ(again, 0);
}

}  // namespace
}  // namespace grelha::test
