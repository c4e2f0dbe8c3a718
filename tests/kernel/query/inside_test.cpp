// Insides of meshes, against rational numbers.
#include "grelha/all_hits.hpp"
#include "grelha/distance.hpp"
#include "grelha/inside.hpp"

#include <gtest/gtest.h>

#include "kernel/query/variants.hpp"
#include "tests/support/inside_cases.hpp"
#include "tests/support/rational_winding.hpp"

namespace grelha::test {
namespace {

constexpr std::size_t kPoints = 400;  ///< a mesh

TEST(Contains, CountsAsRationalCrossings) {
  std::size_t judged = 0, within = 0, wound = 0;
  std::uint64_t seed = 0;
  std::vector<Scene> meshes = closed_meshes();
  for (const Scene& s : flat_sided_meshes())
    meshes.push_back(s);
  for (const Scene& s : meshes) {
    const World world(s, {});
    const std::vector<Float3> points = points_around(s, ++seed, kPoints);
    std::vector<std::uint8_t> inside(points.size());
    contains(world, points, inside, {.threads = 2});
    std::vector<std::uint8_t> nonzero(points.size());
    contains(world, points, nonzero, {.threads = 2, .inside = InsideRule::kNonzero});
    Random random(seed);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(inside[i] != 0, contains(world, points[i])) << "mesh " << seed << ", point " << i;
      const auto expected = rational::winding(s.geometry.triangles, points[i], random);
      if (!expected)
        continue;
      EXPECT_EQ(inside[i] != 0, *expected % 2 != 0) << "mesh " << seed << ", point " << i;
      EXPECT_EQ(nonzero[i] != 0, *expected != 0) << "mesh " << seed << ", point " << i;
      EXPECT_EQ(nonzero[i] != 0, contains(world, points[i], InsideRule::kNonzero));
      ++judged;
      within += inside[i];
      wound += nonzero[i];
    }
  }
  EXPECT_GT(judged, 6 * kPoints);
  EXPECT_GT(within, kPoints);
  EXPECT_GT(wound, within + kPoints / 2);
}

/// More crossings on one side than a walk keeps, and more copies than a cell does.
TEST(Contains, CountsAnyNumberOfCrossings) {
  for (const int copies : {63, 64, 65, 1500, 1501}) {
    Scene s = empty_scene();
    for (int i = 0; i < copies; ++i)
      add_mesh(s, ball_mesh(4, 2), {});
    const World world(s, {});
    EXPECT_EQ(contains(world, {.1f, .05f, .02f}), copies % 2 == 1) << copies;
    EXPECT_FALSE(contains(world, {2, 1, 0})) << copies;
  }
}

/// Of open meshes a point beside the box may be inside.
TEST(Contains, CountsOddCrossingsFromAnywhere) {
  Random random(3);
  const Scene s = one_triangle({-2, -2, 0}, {2, -2, 0}, {0, 2, 0});
  const World world(s, {});
  std::size_t within = 0;
  for (int i = 0; i < 400; ++i) {
    const Float3 p = random.point(2);
    const bool is_inside = contains(world, p, InsideRule::kOdd);
    EXPECT_EQ(is_inside, count_crossings(world, {p, {.4375f, .8125f, .3125f}}) % 2 != 0);
    within += is_inside;
  }
  EXPECT_GT(within, 20u);
}

std::string refusal(const World& world, InsideRule rule, MeshEdge& edge) {
  try {
    contains(world, {0, 0, 0}, rule);
  } catch (const NotClosed& e) {
    edge = e.edge;
    return e.what();
  }
  return "";
}

TEST(Contains, RefusesWhatARuleDoesNotTake) {
  Scene s = ball_mesh(8, 4);
  Triangles& t = s.geometry.triangles;
  std::swap(t.a[5], t.b[5]);
  MeshEdge edge{};
  const World turned(s, {});
  EXPECT_TRUE(contains(turned, {0, 0, 0}));
  EXPECT_EQ(refusal(turned, InsideRule::kNonzero, edge)
                .find("inside: expected an oriented mesh, "
                      "found 3 inconsistent edges, "),
            0u);
  t.a[5] = t.b[5];
  const World open(s, {});
  const std::string told = refusal(open, InsideRule::kClosed, edge);
  EXPECT_EQ(told.find("inside: expected a closed mesh, found 3 open edges, the first from "), 0u);
  EXPECT_NE(told.find(std::to_string(edge.from) + " to " + std::to_string(edge.to) +
                      " of triangle " + std::to_string(edge.id) + "; the rule \"winding\""),
            std::string::npos);
  EXPECT_NE(refusal(open, InsideRule::kNonzero, edge), "");
  EXPECT_EQ(refusal(open, InsideRule::kOdd, edge), "");
  EXPECT_EQ(refusal(open, InsideRule::kWinding, edge), "");
  float distance = 0;
  const Float3 middle{};
  EXPECT_THROW(signed_distance(open, middle), NotClosed);
  EXPECT_THROW(signed_distances(open, {&middle, 1}, {&distance, 1}), NotClosed);
  EXPECT_LT(signed_distance(open, middle, InsideRule::kWinding), 0);
}

TEST(Contains, IsTheSameByEveryInstructionSet) {
  std::uint64_t seed = 20;
  for (const Scene& s : closed_meshes()) {
    const World world(s, {});
    const std::vector<Float3> points = points_around(s, ++seed, kPoints);
    std::vector<std::uint8_t> expected(points.size()), inside(points.size());
    contains(world, points, expected, {.isa = "scalar"});
    for (const Variant* variant : variants()) {
      if (!variant->is_supported())
        continue;
      contains(world, points, inside, {.isa = variant->name});
      EXPECT_EQ(inside, expected) << variant->name << ", mesh " << seed;
    }
  }
}

TEST(Contains, ReportsProgressAndStops) {
  const Scene s = torus_mesh(40, 20, .4);
  const World world(s, {});
  const std::vector<Float3> points(200000, {.5f, .25f, .5f});
  std::vector<std::uint8_t> inside(points.size());
  int calls = 0;
  EXPECT_THROW(
      contains(
          world, points, inside, {.threads = 2, .progress = [&](double) { return ++calls < 3; }}),
      Stopped);
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace grelha::test
