// Compares with long double the test that finds, without a t in double, that a triangle lies behind
// its ray.

#include "tests/support/oracle.hpp"
#include "tests/support/triangles.hpp"

#include <gtest/gtest.h>

namespace grelha::test {
namespace {

/// Rays that the normal says are past their triangle at t_min are: of triangles of any size and
/// place, slivers among them, from origins in their planes up to far above. Rays that start as far
/// above one as surfaces leave room are mostly among them.
TEST(TriangleCrossing, RaysPastAPlaneAreBehindIt) {
  int past = 0;
  int starts = 0;
  int starts_past = 0;
  for (std::uint64_t seed = 0; seed < 400000; ++seed) {
    Random random(seed);
    double size;
    Shape s = random_shape(random, size);
    if (random.chance(.3)) {  // and so small that products underflow
      const double small = random.log_in(1e-19, 1e-9) / size;
      s = {scaled(s.a, small), scaled(s.b, small), scaled(s.c, small)};
      size *= small;
    }
    const bool leaves = random.chance(.5);
    const double u = random.unit();
    const double v = (1 - u) * random.unit();
    const double height = size * (leaves ? 1e-4 : random.log_in(1e-9, 1));
    const Float3 o =
        at(at(at(s.a, u, minus(s.b, s.a)), v, minus(s.c, s.a)), height, random.direction());
    const double speed = random.log_in(1e-3, 1e3);
    const Float3 d = scaled(random.direction(), speed);
    const float t_min =
        leaves || random.chance(.5) ? 0.f : float(random.log_in(1e-6, 10) * size / speed);
    const int k = scalar::largest_axis(d.x, d.y, d.z);
    const scalar::RayAndTriangle<float> pair{
        permute_axes(o, k), permute_axes(d, k), vertices_of(s, k)};
    const bool is_past = scalar::past_plane(pair, t_min);
    const oracle::Facet facet{s.a, s.b, s.c};
    const oracle::Ray ray{o, d};
    const oracle::Real t = dot(facet.a - ray.org, facet.normal()) / dot(ray.dir, facet.normal());
    if (is_past) {
      ++past;
      ASSERT_LT(t, oracle::Real(t_min)) << "seed " << seed;
    }
    starts += leaves && t < 0;
    starts_past += leaves && is_past;
  }
  EXPECT_GT(past, 100000);
  EXPECT_GT(starts_past, starts / 3);
  std::printf(
      "triangle: %d rays past planes; of %d that start on one, %d\n", past, starts, starts_past);
}

}  // namespace
}  // namespace grelha::test
