// hit_triangle: every instruction set and method against the scalar one bit for bit; the scalar one against long
// double.
#define GRELHA_ISA scalar
#include "kernel/triangle.hpp"

#include "tests/support/oracle.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

class Triangle : public EveryVariant {};
GRELHA_FOR_EVERY_ISA(Triangle);

struct Shape {
  Float3 a, b, c;
};

/// Any size and place; some slivers, some along the axes, some with whole coordinates.
Shape random_shape(Random& random, double& size) {
  size = random.log_in(1e-12, 1e12);
  Shape s;
  s.a = random.chance(.3) ? Float3{} : random.point(size * random.log_in(1e-2, 1e3));
  s.b = at(s.a, size, random.direction());
  s.c = random.chance(.2) ? at(s.b, size * 1e-3, random.direction())
                          : at(s.a, size * random.in(.2, 1), random.direction());
  if (random.chance(.2)) {
    const std::uint32_t axis = random.below(3);
    component(s.b, axis) = component(s.c, axis) = component(s.a, axis);
  }
  return s;
}

TEST_P(Triangle, ReturnsTheScalarBits) {
  std::size_t hits = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    double size;
    const Shape s = random_shape(random, size);
    const Scene scene = one_triangle(s.a, s.b, s.c);
    const World world(scene, {.grid = false});
    Rays rays = rays_about(random, s.a, size, kManyRays / 2);
    while (rays.size() < kManyRays) {  // and at its corners, edges and middle, which the sweep seldom meets
      const double u = random.below(5) * .25, v = (1 - u) * random.below(5) * .25;
      const Float3 aim = at(at(s.a, u, minus(s.b, s.a)), v, minus(s.c, s.a)),
                   org = random.point(size * random.log_in(1, 1e3));
      rays.add(org, scaled(minus(aim, org), random.log_in(1e-3, 1e3)));
    }
    rays = with_odd_values(random, rays, seed % 2 ? .1 : 0);
    const Truth truth = truth_of(scene, rays);
    expect_truth(variant(), world, rays, truth, "seed " + std::to_string(seed));
    hits += hits_of(truth.closest);
  }
  EXPECT_GT(hits, 60u * kManyRays / 10);
}

struct Hit {
  bool hit;
  float t;
  oracle::Real weights[3];
};

Hit hit(const Float3& o, const Float3& d, const Shape& s, float t_min = 0) {
  const int k = scalar::shear_axis(d.x, d.y, d.z);
  const auto permute = [&](const Float3& p) {
    const float q[3] = {p.x, p.y, p.z};
    return scalar::Vec3<float>{q[k == 2 ? 0 : k + 1], q[k == 0 ? 2 : k - 1], q[k]};
  };
  const scalar::Vec3<float> dir = permute(d);
  scalar::Vec3<float> w{0, 0, 0};
  float t = -1, again = -1;
  const scalar::Shear<float> shear{dir.x / dir.z, dir.y / dir.z, 1 / dir.z};
  const bool h = scalar::hit_triangle<float>(permute(o), shear, t_min, permute(s.a), permute(s.b), permute(s.c), t);  // as when traced
  scalar::hit_triangle<float>(permute(o), shear, t_min, permute(s.a), permute(s.b), permute(s.c), again, &w);         // as when shaded
  return {h, t, {w.x, w.y, w.z}};
}

/// Farthest corner from the origin: a sheared corner is off by a few eps of that, and so is all that follows.
oracle::Real reach_of(const Float3& o, const Shape& s) {
  return std::max({length(oracle::V(s.a) - oracle::V(o)), length(oracle::V(s.b) - oracle::V(o)),
                   length(oracle::V(s.c) - oracle::V(o))});
}

/// A sheared coordinate takes the roundings of a difference (1 eps), of the shear (1), of its product (1) and of the
/// last difference (1), with |shear| <= 1: each corner is off by at most 4 eps max|corner - org| on each of two axes,
/// hence the ray passes the sheared outline within 4 sqrt(2) < 6 of these of where it passes the true one. World::Impl
/// counts on 46.
constexpr oracle::Real kOutline = 6;

TEST(TriangleOracle, DecidesLikeTheExactOutline) {
  int judged = 0, inside = 0;
  for (std::uint64_t seed = 0; seed < 400000; ++seed) {
    Random random(seed);
    double size;
    const Shape s = random_shape(random, size);
    const double u = random.in(-.2, 1.2), v = random.in(-.2, 1.2 - u);
    const Float3 aim = at(at(s.a, u, minus(s.b, s.a)), v, minus(s.c, s.a));
    const Float3 o = at(s.a, size * random.log_in(1e-1, 1e4), random.direction());
    const Float3 d = scaled(minus(aim, o), random.log_in(1e-2, 1e2));
    const oracle::Facet facet{s.a, s.b, s.c};
    const oracle::Ray ray{o, d};
    const oracle::Real clear = facet.clearance(ray), tolerance = kOutline * oracle::kEps * reach_of(o, s);
    if (std::abs(clear) <= tolerance || facet.distance(ray.org) <= 32 * tolerance) continue;
    const oracle::Real t_plane = dot(facet.a - ray.org, facet.normal()) / dot(ray.dir, facet.normal());
    ++judged, inside += clear > 0;
    ASSERT_EQ(hit(o, d, s).hit, clear > 0 && t_plane > 0)
        << "seed " << seed << ", " << static_cast<double>(clear / tolerance) << " clear";
  }
  EXPECT_GT(judged, 100000);
  EXPECT_GT(inside, 20000);
}

/// How far the point found lies from the triangle, slivers included. Two parts: the sheared corners are off by eps reach
/// (above); and the edge functions are differences of products of about L^2, so each weight is off by about 2 eps L^2 / det,
/// and the point slides along the triangle by that times L. Where L^3 / det exceeds 4 reach the test takes them in double,
/// so both together stay below (1 + 4) 6 eps reach; World::Impl counts on 46.
TEST(TriangleOracle, PointsLieOnTheTriangle) {
  oracle::Real worst = 0, worst_weights = 0;
  int hits = 0, slivers = 0, over = 0;
  for (std::uint64_t seed = 0; seed < 400000; ++seed) {
    Random random(seed);
    double size;
    const Shape s = random_shape(random, size);
    const double u = random.unit(), v = (1 - u) * random.unit();
    const Float3 aim = at(at(s.a, u, minus(s.b, s.a)), v, minus(s.c, s.a));
    const Float3 o = at(s.a, size * random.log_in(1e-1, 1e4), random.direction());
    const Float3 d = scaled(minus(aim, o), random.log_in(1e-2, 1e2));
    const Hit h = hit(o, d, s);
    if (!h.hit) continue;
    ++hits;
    const oracle::Facet facet{s.a, s.b, s.c};
    const oracle::Ray ray{o, d};
    const oracle::V direction = oracle::unit(d);
    const oracle::Real l = std::max({length(facet.b - facet.a), length(facet.c - facet.a), length(facet.c - facet.b)});
    slivers += l * l / std::abs(dot(facet.normal(), direction)) > 1000;
    const oracle::Real unit = oracle::kEps * reach_of(o, s), off = facet.distance(ray.point(h.t));
    const oracle::V gap = (facet.a - ray.org) + h.weights[1] * (facet.b - facet.a) + h.weights[2] * (facet.c - facet.a);
    const oracle::Real beside = length(gap - dot(gap, direction) * direction);
    if (!(off <= 32 * unit && beside <= 32 * unit) && ++over <= 3)
      ADD_FAILURE() << "seed " << seed << ": " << double(off / unit) << " and " << double(beside / unit)
                    << " units off";
    worst = std::max(worst, off / unit), worst_weights = std::max(worst_weights, beside / unit);
  }
  std::printf("triangle: %d hits, %d on slivers, off the triangle %.2f, off the ray %.2f eps reach\n", hits, slivers,
              double(worst), double(worst_weights));
  EXPECT_EQ(over, 0);
  EXPECT_GT(hits, 100000);
  EXPECT_GT(slivers, 1000);
}

TEST(TriangleCorners, EdgesCornersAndSides) {
  const Shape s{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, back{{0, 0, 0}, {0, 4, 0}, {4, 0, 0}};
  for (const Shape& k : {s, back}) {
    EXPECT_EQ(hit({1, 1, 5}, {0, 0, -1}, k).t, 5);
    EXPECT_EQ(hit({1, 1, -5}, {0, 0, 2}, k).t, 2.5f);
    EXPECT_TRUE(hit({0, 0, 5}, {0, 0, -1}, k).hit);
    EXPECT_TRUE(hit({4, 0, 5}, {0, 0, -1}, k).hit);
    EXPECT_TRUE(hit({2, 0, 5}, {0, 0, -1}, k).hit);
    EXPECT_TRUE(hit({2, 2, 5}, {0, 0, -1}, k).hit);
    EXPECT_TRUE(hit({0, -0.f, 5}, {-0.f, 0, -1}, k).hit);
    EXPECT_FALSE(hit({2, 2.000001f, 5}, {0, 0, -1}, k).hit);
    EXPECT_FALSE(hit({2, -1e-30f, 5}, {0, 0, -1}, k).hit);
    EXPECT_FALSE(hit({1, 1, 5}, {0, 0, 1}, k).hit);
    EXPECT_FALSE(hit({-1, 1, 0}, {1, 0, 0}, k).hit);     // in its plane
    EXPECT_FALSE(hit({1, 1, 5}, {0, 0, -1}, k, 5).hit);  // the interval is open
  }
  EXPECT_FALSE(hit({1, 0, 5}, {0, 0, -1}, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}).hit);  // no area
  EXPECT_FALSE(hit({0, 0, 5}, {0, 0, -1}, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}).hit);
}

/// An edge function that is zero in float but not in truth: of two neighbours exactly one is met, the one that holds
/// the ray. (1 + 2^-22) 1 and (1 + 2^-23)^2 round alike and differ by 2^-46.
TEST(TriangleCorners, ZeroEdgesAreTakenAgain) {
  for (const float k : {1.f, 1e-10f, 1e10f}) {
    const auto point = [&](float x, float y) { return Float3{x * k, y * k, 0}; };
    const Float3 b = point(1 + 0x1p-23f, 1), c = point(-1 - 0x1p-22f, -1 - 0x1p-23f), left = point(-1, 1),
                 right = point(1, -1);
    if (k != 1) {  // scaled corners round anew; what must stay is that the pair has no hole
      EXPECT_GE(hit({0, 0, 5 * k}, {0, 0, -1}, {left, b, c}).hit + hit({0, 0, 5 * k}, {0, 0, -1}, {right, b, c}).hit, 1)
          << k;
      continue;
    }
    const bool in_left = hit({0, 0, 5}, {0, 0, -1}, {left, b, c}).hit,
               in_right = hit({0, 0, 5}, {0, 0, -1}, {right, b, c}).hit;
    EXPECT_NE(in_left, in_right);
    const oracle::Facet facet{left, b, c};
    EXPECT_EQ(in_left, facet.clearance({oracle::V{0, 0, 5}, oracle::V{0, 0, -1}}) > 0);
  }
}

/// Embree #387: a sliver met at half a degree was reported at twenty times the distance of its farthest corner.
TEST(TriangleCorners, DepthStaysWithinThatOfTheCorners) {
  for (std::uint64_t seed = 0; seed < 100000; ++seed) {
    Random random(seed);
    const Float3 a = random.point(10);
    const Shape s{a, at(a, 11.2, random.direction()), at(a, 1.4, random.direction())};
    const Float3 aim = at(at(a, .3, minus(s.b, a)), .3, minus(s.c, a));
    // Nearly in the plane: along an edge, tilted by half a degree or a thousandth of it.
    const Float3 d = at(minus(s.b, a), 11.2 * random.log_in(1e-5, 1e-2), random.direction()), o = at(aim, -50, d);
    const Hit h = hit(o, d, s, -kInf);
    if (!h.hit) continue;
    const int k = scalar::shear_axis(d.x, d.y, d.z);
    const auto depth = [&](const Float3& p) {
      const oracle::Real q[3] = {oracle::Real(p.x) - o.x, oracle::Real(p.y) - o.y, oracle::Real(p.z) - o.z},
                         r[3] = {d.x, d.y, d.z};
      return q[k] / r[k];
    };
    const oracle::Real least = std::min({depth(s.a), depth(s.b), depth(s.c)}),
                       most = std::max({depth(s.a), depth(s.b), depth(s.c)});
    const oracle::Real slack = 8 * oracle::kEps * std::max(std::abs(least), std::abs(most));
    ASSERT_TRUE(h.t >= least - slack && h.t <= most + slack) << "seed " << seed << ": t " << h.t;
  }
}

}  // namespace
}  // namespace grelha::test
