// Generalized winding numbers, against long double.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <limits>

#include "grelha/distance.hpp"
#include "grelha/inside.hpp"
#include "kernel/query/winding_sum.hpp"
#include "kernel/query/variants.hpp"
#include "tests/support/inside_cases.hpp"
#include "tests/support/rational.hpp"
#include "tests/support/solid_angle.hpp"

namespace grelha::test {
namespace {

constexpr std::size_t kPoints = 120;  ///< a mesh

std::vector<Scene> meshes() {
  std::vector<Scene> all = open_meshes();
  for (const Scene& s : closed_meshes())
    all.push_back(s);
  return all;
}

TEST(AngleOf, IsThatOfLongDouble) {
  Random random(1);
  for (int i = 0; i < 200000; ++i) {
    const double x = random.sign() * random.log_in(1e-6, 1), y = random.sign() * random.unit();
    const long double expected = std::atan2(static_cast<long double>(y), x);
    EXPECT_NEAR(scalar::angle_of<double>(x, y), static_cast<double>(expected), 0x1p-50);
  }
  EXPECT_EQ(scalar::angle_of<double>(0, 0), 0);
  EXPECT_EQ(scalar::angle_of<double>(2, 0), 0);
  EXPECT_EQ(scalar::angle_of<double>(0, -1), -scalar::angle_of<double>(0, 1));
}

TEST(WindingNumber, LeavesOutTrianglesThatAreNotFinite) {
  for (const float wrong : {std::numeric_limits<float>::quiet_NaN(), 1e30f * 1e30f}) {
    const Scene whole = closed_meshes().front();
    Scene s = whole;
    add_triangle(s, {wrong, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const World world(s, {}), expected(whole, {});
    Random random(3);
    for (int i = 0; i < 40; ++i) {
      const Float3 point = 2.f * random.unit() * random.direction();
      EXPECT_NEAR(grelha::winding_number(world, point, 1e-6),
                  grelha::winding_number(expected, point, 1e-6),
                  2e-6);
    }
  }
}

/// The winding number of a triangle by the kernel's formula, in 400 bits.
double number_of_400_bits(const Float3 (&corner)[3], const Float3& p) {
  const auto wide = [](double x) { return mpf_class(x, 400); };
  std::array<std::array<mpf_class, 3>, 3> to;
  for (std::size_t k = 0; k < 3; ++k)
    to[k] = {wide(corner[k].x) - wide(p.x),
             wide(corner[k].y) - wide(p.y),
             wide(corner[k].z) - wide(p.z)};
  const auto product = [](const auto& u, const auto& v) -> mpf_class {
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  };
  const auto size = [&](std::size_t k) -> mpf_class { return sqrt(product(to[k], to[k])); };
  const std::array<mpf_class, 3> n = {to[0][1] * to[1][2] - to[0][2] * to[1][1],
                                      to[0][2] * to[1][0] - to[0][0] * to[1][2],
                                      to[0][0] * to[1][1] - to[0][1] * to[1][0]};
  const mpf_class real = size(0) * size(1) * size(2) + product(to[0], to[1]) * size(2) +
                         product(to[1], to[2]) * size(0) + product(to[2], to[0]) * size(1);
  const mpf_class volume = product(n, to[2]);
  const mpf_class scale = abs(real) + abs(volume);
  return std::atan2(mpf_class(volume / scale).get_d(), mpf_class(real / scale).get_d()) /
         (2 * std::numbers::pi);
}

/// Beside two long edges at once both parts of the complex number nearly cancel.
TEST(WindingNumber, BesideNeedlesIsWithinTheErrorAllowed) {
  Random random(12);
  double nearest = 1;
  for (int i = 0; i < 20000; ++i) {
    const Float3 a = random.chance(.5) ? Float3{} : random.point(1);
    const double size = random.log_in(1e-3, 1e3);
    const Float3 b = at(a, size, random.direction());
    const double width = size * random.log_in(1e-7, 1);
    const Float3 c = at(random.chance(.5) ? a : b, width, random.direction());
    const double along = random.unit();
    const Float3 p = at(at(a, along, minus(b, a)),
                        size * random.log_in(0x1p-24, .1) * (random.chance(.1) ? 100 : 1),
                        random.direction());
    const auto beside = [&](const Float3& from, const Float3& to) {
      const oracle::V edge = brute::v(minus(to, from));
      const oracle::V way = brute::v(minus(p, from));
      return static_cast<double>(length(cross(edge, way)) / dot(edge, edge));
    };
    const double least = std::min({beside(a, b), beside(b, c), beside(c, a)});
    if (!(least > 0x1p-24))
      continue;
    nearest = std::min(nearest, least);
    const Scene s = one_triangle(a, b, c);
    const World world(s, {});
    const double expected = number_of_400_bits({a, b, c}, p);
    ASSERT_NEAR(grelha::winding_number(world, p, 1e-12), expected, 1e-12 + 0x1p-42) << i;
  }
  EXPECT_LT(nearest, 0x1p-22);
}

/// A small triangle at the end of a stick that turns its face along it: what is left out is as
/// large there as the bound says. Products of ten lengths leave the range of doubles.
class WindingBound : public testing::TestWithParam<float> {};

TEST_P(WindingBound, IsReached) {
  const float scale = GetParam();
  Random random(5);
  double nearest = 0;
  for (int i = 0; i < 60; ++i) {
    const Float3 way = random.direction();
    const Float3 across = normalized(cross(way, random.direction())), up = cross(way, across);
    const Float3 normal = i % 2 == 0 ? way : random.direction();
    const Float3 e = normalized(cross(normal, across)), f = cross(normal, e);
    Scene s = empty_scene();
    const float size = .01f;
    add_triangle(s, scale * way, scale * (way + size * e), scale * (way + size * f));
    const Float3 other = -1.f * way;
    add_triangle(s, scale * other, scale * (other + 1e-5f * across), scale * (other + 1e-5f * up));
    const World world(s, {});
    const Float3 point = scale * (static_cast<float>(random.log_in(2, 50)) * way);
    const auto expected = static_cast<double>(winding_number(s.geometry.triangles, point));
    for (double error = 1e-12; error < 1e-3; error *= 1.05) {
      const double off = std::abs(grelha::winding_number(world, point, error) - expected);
      ASSERT_LE(off, error + 1e-15) << i;
      nearest = std::max(nearest, off > 1e-14 ? off / error : 0);
    }
  }
  EXPECT_GT(nearest, .5);
}

INSTANTIATE_TEST_SUITE_P(Sizes, WindingBound, testing::Values(1, 0x1p-108f, 0x1p100f));

/// However little error is allowed, and from however far away.
TEST(WindingNumber, IsWithinTheErrorAllowed) {
  std::uint64_t seed = 0;
  double largest = 0;
  for (const Scene& s : meshes()) {
    const World world(s, {});
    const std::vector<Float3> points = points_around(s, ++seed, kPoints);
    for (const double error : {1., .1, 0x1p-7, 1e-4, 1e-8}) {
      std::vector<double> numbers(points.size());
      winding_numbers(world, points, numbers, error, {.threads = 2});
      for (std::size_t i = 0; i < points.size(); ++i) {
        const auto expected = static_cast<double>(winding_number(s.geometry.triangles, points[i]));
        EXPECT_NEAR(numbers[i], expected, error + 1e-9) << "mesh " << seed << ", point " << i;
        largest = std::max(largest, std::abs(numbers[i] - expected));
        if (i % 10 == 0) {
          EXPECT_EQ(numbers[i], grelha::winding_number(world, points[i], error));
        }
      }
    }
  }
  EXPECT_GT(largest, 1e-3) << "all numbers were exact";
}

/// Triangles near a point, and how far off their winding number may be from far away.
struct Heap {
  Float3 middle;
  double area = 0, spread = 0, radius = 0;

  void add(Scene& s, const Float3 (&corner)[3]) {
    add_triangle(s, corner[0], corner[1], corner[2]);
    const oracle::V normal =
        cross(brute::v(minus(corner[1], corner[0])), brute::v(minus(corner[2], corner[0])));
    const auto own = static_cast<double>(length(normal)) / 2;
    area += own;
    for (const Float3& p : corner) {
      const auto away = static_cast<double>(length(brute::v(minus(p, middle))));
      spread += own * away * away / 3;
      radius = std::max(radius, away);
    }
  }
  /// The terms left out are 4 q^3 + 5 q^4 + ..., with q the size over the distance.
  double error(const Float3& p) const {
    const auto distance = static_cast<double>(length(brute::v(minus(middle, p))));
    return 4.2 * radius * spread / std::pow(distance, 5) / (4 * std::numbers::pi);
  }
};

/// Eight heaps at the corners of a cube are the clusters of the uppermost row. A term with a wrong
/// factor is of an order less than what may be left out.
TEST(WindingNumber, HasTheTermsOfClusters) {
  Random random(11);
  for (const int in_heap : {8, 64, 512})
    for (int round = 0; round < 40; ++round) {
      Scene s = empty_scene();
      const Float3 p = random.point(900);
      double allowed = 0;
      for (int i = 0; i < 8; ++i) {
        const auto side = [&](int bit) { return (i & bit) != 0 ? 3e3f : -3e3f; };
        Heap heap{at({side(1), side(2), side(4)}, 1, random.point(200))};
        for (int k = 0; k < in_heap; ++k) {
          const auto corner = [&] { return at(heap.middle, 1, random.point(1)); };
          heap.add(s, {corner(), corner(), corner()});
        }
        allowed += heap.error(p);
      }
      const oracle::Real expected = winding_number(s.geometry.triangles, p, small_solid_angle);
      const double found = grelha::winding_number(World(s, {}), p, 1);
      EXPECT_LT(std::abs(found - expected), allowed) << in_heap;
    }
}

TEST(WindingNumber, TellsInsideOfOpenMeshes) {
  std::uint64_t seed = 30;
  std::size_t within = 0;
  for (const Scene& s : meshes()) {
    const World world(s, {});
    const std::vector<Float3> points = points_around(s, ++seed, kPoints);
    std::vector<std::uint8_t> inside(points.size());
    std::vector<float> distances(points.size());
    contains(world, points, inside, {.inside = InsideRule::kWinding});
    signed_distances(world, points, distances, {.inside = InsideRule::kWinding});
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto expected = static_cast<double>(winding_number(s.geometry.triangles, points[i]));
      if (std::abs(std::abs(expected) - .5) < 1e-5)
        continue;
      EXPECT_EQ(inside[i] != 0, std::abs(expected) > .5) << "mesh " << seed << ", point " << i;
      EXPECT_EQ(distances[i] < 0, inside[i] != 0 && distances[i] != 0);
      within += inside[i];
    }
  }
  EXPECT_GT(within, 3 * kPoints);
}

TEST(WindingNumber, HasTheSameBitsByEveryInstructionSetAndGrid) {
  std::uint64_t seed = 60;
  for (const Scene& s : open_meshes()) {
    const World world(s, {}), other(s, {.density = 9}), plain(s, {.grid = false});
    const std::vector<Float3> points = points_around(s, ++seed, kPoints);
    std::vector<double> expected(points.size()), numbers(points.size());
    std::vector<std::uint8_t> expected_inside(points.size()), inside(points.size());
    winding_numbers(world, points, expected, .01, {.isa = "scalar"});
    contains(world, points, expected_inside, {.isa = "scalar", .inside = InsideRule::kWinding});
    const auto expect_same = [&](const World& asked, std::string_view isa) {
      winding_numbers(asked, points, numbers, .01, {.isa = isa, .threads = 3});
      contains(asked, points, inside, {.isa = isa, .inside = InsideRule::kWinding});
      for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_EQ(std::bit_cast<std::uint64_t>(numbers[i]),
                  std::bit_cast<std::uint64_t>(expected[i]))
            << isa;
      EXPECT_EQ(inside, expected_inside) << isa;
    };
    for (const Variant* variant : variants())
      if (variant->is_supported())
        expect_same(world, variant->name);
    expect_same(other, "best");
    expect_same(plain, "best");
  }
}

/// So near to a triangle that doubles do not tell the side.
TEST(WindingNumber, KnowsOnWhichSideAPointLies) {
  Random random(9);
  int on = 0, above = 0, below = 0;
  for (int i = 0; i < 3000; ++i) {
    Float3 corner[3];
    for (Float3& p : corner)
      p = at({3, 5, 7}, 1, random.point(1));
    const bool is_whole = random.chance(.3);  // then points lie in the plane now and then
    for (Float3& p : corner)
      if (is_whole)
        p = {std::floor(p.x), std::floor(p.y), std::floor(p.z)};
    Float3 p = at(at(corner[0], .4, minus(corner[1], corner[0])), .25, minus(corner[2], corner[0]));
    if (is_whole)
      p = at(corner[0], .5, minus(corner[1], corner[0]));
    const Scene s = one_triangle(corner[0], corner[1], corner[2]);
    const rational::Vector org(p);
    const rational::Vector a = rational::Vector(corner[0]) - org,
                           b = rational::Vector(corner[1]) - org,
                           c = rational::Vector(corner[2]) - org;
    const int side = sgn(dot(cross(a, b), c));
    const double found = grelha::winding_number(World(s, {}), p);
    EXPECT_EQ((found > 0) - (found < 0), side);
    if (side != 0 && !is_whole) {
      EXPECT_NEAR(std::abs(found), .5, 1e-4);
    }
    on += side == 0;
    above += side < 0;
    below += side > 0;
  }
  EXPECT_GT(on, 300);
  EXPECT_GT(above, 300);
  EXPECT_GT(below, 300);
}

TEST(WindingNumber, KnowsASideThatDoublesLose) {
  const Scene s = one_triangle({-1, -1, -1}, {2, 2, -1}, {-1, -1, 2});
  const World world(s, {});
  EXPECT_EQ(grelha::winding_number(world, {}), 0);
  for (const float beside : {0x1p-20f, 0x1p-60f, 0x1p-140f}) {
    EXPECT_NEAR(grelha::winding_number(world, {-beside, 0, 0}), .5, 1e-6);
    EXPECT_NEAR(grelha::winding_number(world, {beside, 0, 0}), -.5, 1e-6);
    EXPECT_NEAR(grelha::winding_number(world, {0, beside, 0}), .5, 1e-6);
  }
}

TEST(WindingNumber, OfOddPoints) {
  const Scene s = ball_mesh(16, 8);
  const World world(s, {});
  EXPECT_TRUE(std::isnan(grelha::winding_number(world, {kNaN, 0, 0})));
  EXPECT_TRUE(std::isnan(grelha::winding_number(world, {0, kInf, 0})));
  EXPECT_FALSE(contains(world, {0, -kInf, 0}, InsideRule::kWinding));
  EXPECT_NEAR(grelha::winding_number(world, {1e18f, 0, 0}), 0, 1e-9);
  EXPECT_THROW(grelha::winding_number(world, {}, 0), std::invalid_argument);
  EXPECT_THROW(grelha::winding_number(world, {}, -1), std::invalid_argument);
  std::vector<double> numbers(3);
  EXPECT_THROW(winding_numbers(world, std::vector<Float3>(2), numbers), std::invalid_argument);
  const Scene empty = empty_scene(), ball = one_sphere({1, 0, 0}, 2);
  EXPECT_EQ(grelha::winding_number(World(empty, {}), {}), 0);
  EXPECT_TRUE(contains(World(ball, {}), {}, InsideRule::kWinding));
}

}  // namespace
}  // namespace grelha::test
