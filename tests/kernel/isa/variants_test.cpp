// Tests the compiled copies of the kernel: the list of copies, that the requested copy is the one
// that runs, and that all copies and methods agree on scenes of every kind.
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

TEST(Variants, ScalarIsFirstAndWidthsGrow) {
  const auto all = variants();
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all.front()->name, "scalar");
  EXPECT_TRUE(all.front()->is_supported());
  for (std::size_t i = 1; i < all.size(); ++i)
    EXPECT_GT(all[i]->lanes, all[i - 1]->lanes);
  for (const Variant* v : all)
    EXPECT_EQ(find_variant(v->name), v);
  EXPECT_EQ(find_variant("mmx"), nullptr);
  EXPECT_EQ(find_variant(""), nullptr);
}

TEST(Variants, BestIsTheWidestThatRuns) {
  const Variant* widest = nullptr;
  for (const Variant* v : variants())
    if (v->is_supported())
      widest = v;
  EXPECT_EQ(find_variant("best"), widest);
}

TEST(Variants, IsasListsAllKnown) {
  const auto all = isas();
  ASSERT_EQ(all.size(), 5u);
  for (const Isa& isa : all) {
    EXPECT_EQ(isa.compiled, find_variant(isa.name) != nullptr) << isa.name;
    EXPECT_LE(isa.is_supported, isa.compiled) << isa.name;
  }
}

class Copies : public EveryVariant {};
GRELHA_FOR_EVERY_ISA(Copies);

/// Of rays that go by themselves all that is tested is tested in rows. These are not to grow: the
/// bounds are a twentieth above what a ray tested when they were set.
TEST_P(Copies, CountRowsOfLoneRays) {
  const Scene scene = ball_mesh(48, 24);
  const World world(scene, {});
  ASSERT_FALSE(world.impl().grids.empty());
  Random random(4);
  const RayList rays = rays_about(random, {}, 1, 500);
  const Answers a = trace(variant(), world, rays, {1, true}, Query::kClosest);
  EXPECT_GT(hits_of(a), 100u);
  const auto rows_a_ray = [&](std::uint64_t rows) { return double(rows) / double(rays.size()); };
  EXPECT_LE(rows_a_ray(a.counts.rows.boxes), 1.25);
  EXPECT_LE(rows_a_ray(a.counts.rows.primitives), 1.51);
  EXPECT_EQ(a.counts.rows.primitives * kBlock, a.counts.tests.triangle);
}

/// Lanes are issued in whole registers of this copy: one ray alone costs as many lanes as the copy
/// claims to have.
TEST_P(Copies, RunAtTheirOwnWidth) {
  const Scene scene = one_sphere({}, 1);
  const World world(scene, {.grid = false});
  RayList rays;
  rays.add({0, 0, 5}, {0, 0, -1});
  const Answers a = trace(variant(), world, rays, {16, true}, Query::kClosest);
  EXPECT_EQ(a.counts.packets.lanes_issued, static_cast<std::uint64_t>(variant().lanes));
  EXPECT_EQ(a.counts.packets.lanes_busy, 1u);
  EXPECT_EQ(a.counts.tests.sphere, 1u);
  EXPECT_EQ(a.counts.rows.primitives, 0u);
  RenderStats stats;
  RenderOptions options;
  options.isa = variant().name;
  Camera camera;
  camera.width = camera.height = 4;
  render(world, camera, options, stats);
  EXPECT_EQ(stats.isa, variant().name);
}

TEST_P(Copies, ReturnTheScalarBits) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    const double scale = random.log_in(1e-4, 1e4);
    const Float3 offset = random.point(scale * random.log_in(.1, 1e3));
    const Scene scene = placed(random_mixture(seed, 150), scale, offset);
    const World world(scene, {});
    const RayList rays =
        with_odd_values(random, rays_about(random, offset, scale, kManyRays), seed % 2 ? .1 : 0);
    const Truth truth = truth_of(scene, rays);
    EXPECT_GT(hits_of(truth.closest), 300u);
    expect_truth(variant(), world, rays, truth, "seed " + std::to_string(seed));
  }
}

/// Rays about a scene of unit size, some from so far away that the kernel moves them near, some
/// invalid.
RayList rays_of_every_kind(Random& random) {
  RayList rays = with_odd_values(random, rays_about(random, {}, 1, kManyRays), .05);
  rays.add(rays_about(random, {}, 1e5, 200));
  rays.add({1e6f, 2e6f, -3e6f}, {-1, -2, 3});
  rays.add({.5f, .25f, 2}, {0, 0, -1}, 1, 1);
  rays.add({.5f, .25f, 2}, {0, 0, -1}, 2, 1);
  return rays;
}

/// Compares calls for single rays with a stream of all rays.
void expect_calls_like_streams(const Variant& variant,
                               const Scene& scene,
                               const RayList& rays,
                               const char* name) {
  for (const bool grid : {true, false}) {
    const World world(scene, {.grid = grid});
    const Answers met = trace(*find_variant("scalar"), world, rays, {1, true}, Query::kClosest);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Ray ray{rays.org(i), rays.dir(i), rays.t_min[i], rays.t[i]};
      const Hit hit = variant.loops.closest_one(world.impl().view, ray, nullptr);
      ASSERT_EQ(hit.id, met.id[i]) << name << ", " << rays.describe(i);
      ASSERT_EQ(std::bit_cast<std::uint32_t>(hit.t), std::bit_cast<std::uint32_t>(met.t[i]))
          << name << ", " << rays.describe(i) << ", " << hit.t << " not " << met.t[i];
      ASSERT_EQ(variant.loops.occluded_one(world.impl().view, ray, nullptr),
                met.id[i] != kNoPrimitive)
          << name << ", " << rays.describe(i);
    }
  }
}

/// A call for one ray takes the best copy; the others are as right.
TEST_P(Copies, AskOneRayAsInAStream) {
  Random random(12);
  const RayList rays = rays_of_every_kind(random);
  const auto expect_same = [&](const Scene& scene, const char* name) {
    expect_calls_like_streams(variant(), scene, rays, name);
  };
  expect_same(empty_scene(), "nothing");
  expect_same(random_spheres(12, 2000), "spheres");
  expect_same(random_triangles(13, 2000), "triangles");
  expect_same(random_mixture(14, 700), "mixture");
  Scene planes = random_mixture(15, 200);
  planes.geometry.planes.add({0, 0, -3}, {0, 1, 8}, 0);
  planes.geometry.planes.add({0, -2, 0}, {0, 1, 0}, 0);
  expect_same(planes, "planes");
  expect_same(stadium(16, 300), "primitives in no grid");
  Scene apart = ball_mesh(32, 16);
  apart.geometry.objects.push_back({0, std::uint32_t(apart.geometry.triangles.size())});
  add_triangles(apart, random, 100, 30, .1, 1);
  ASSERT_GT(World(apart, {}).grids().size(), 1u);
  expect_same(apart, "two grids");
}

TEST_P(Copies, LeapOverEmptyCellsWithOneRayAsInAStream) {
  const Scene corners = triangles_at_corners(17, 2400);
  const World world(corners, {});
  const GridView& grid = world.impl().view.grids[0];
  ASSERT_EQ(world.grids().size(), 1u);
  ASSERT_GE(*std::max_element(grid.distance, grid.distance + grid.n[0] * grid.n[1] * grid.n[2]), 3);
  Random random(18);
  RayList rays;
  for (std::uint32_t i = 0; i < 2400; ++i) {
    const Float3 from = random.point(2);
    rays.add(from, minus(vertex(corners, 3 * i), from));
  }
  expect_calls_like_streams(variant(), corners, rays, "corners of a cube");
}

/// Counts of rays of 0 to 70: every tail of every packet and register, and nothing written behind
/// the last.
TEST_P(Copies, TakeAnyNumberOfRays) {
  const Scene scene = random_mixture(2, 60);
  const World world(scene, {});
  Random random(2);
  const RayList all = rays_about(random, {}, 1, 70);
  const Truth truth = truth_of(scene, all);
  for (std::size_t n = 0; n <= 70; ++n)
    for (const Way& way : every_way()) {
      std::vector<float> t(70, 77);
      std::vector<std::uint32_t> id(70, 77);
      std::vector<std::uint8_t> blocked(70, 77);
      TraceCounts counts;
      Rays rays = all.view();
      rays.count = n;
      const SceneView& view = world.impl().view;
      variant().loops.closest(view, rays, {t.data(), id.data()}, way.settings, counts);
      variant().loops.occluded(view, rays, blocked.data(), way.settings, counts);
      for (std::size_t i = 0; i < 70; ++i) {
        const std::string what = std::string(way.name) + ", " + std::to_string(n) + " rays, ray ";
        const bool met = truth.closest.id[i] != kNoPrimitive;
        ASSERT_EQ(id[i], i < n ? truth.closest.id[i] : 77u) << what << i;
        ASSERT_EQ(t[i], i < n ? truth.closest.t[i] : 77) << what << i;
        ASSERT_EQ(blocked[i], i < n ? met : 77) << what << i;
      }
    }
}

/// variants.hpp: where nothing is hit t keeps its old value; so too for rays that cannot be traced.
TEST_P(Copies, LeaveTOfUnsoundRaysAlone) {
  const Scene scene = random_mixture(2, 60);
  const World world(scene, {});
  RayList rays;
  for (const float bad : {kNaN, kInf, -kInf})
    for (int field = 0; field < 6; ++field) {
      rays.add({.1f, .2f, 5}, {0, 0, -1}, 0, field % 2 ? kInf : 100);
      (*std::array{&rays.ox,
                   &rays.oy,
                   &rays.oz,
                   &rays.dx,
                   &rays.dy,
                   &rays.dz}[static_cast<std::size_t>(field)])
          .back() = bad;
    }
  rays.add({.1f, .2f, 5}, {0, -0.f, 0});
  for (const Way& way : every_way())
    for (const Query query : {Query::kClosest, Query::kOccluded}) {
      const Answers a = trace(variant(), world, rays, way.settings, query);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(a.id[i], kNoPrimitive) << way.name << ", " << rays.describe(i);
        EXPECT_EQ(a.t[i], rays.t[i]) << way.name << ", " << rays.describe(i);
      }
    }
}

/// The interval searched is open at both ends and may lie anywhere, also before the origin.
TEST_P(Copies, KeepToTheInterval) {
  const Scene scene = one_sphere({}, 1);
  const World world(scene, {.grid = false});
  RayList rays;
  const auto add = [&](float from, float to) { rays.add({0, 0, 5}, {0, 0, -1}, from, to); };
  add(0, kInf);
  add(0, 4);
  add(4, 6);
  add(4, kInf);
  add(3, 4.0000005f);
  add(6, kInf);
  add(5, 5);
  add(9, 2);
  add(kNaN, kInf);
  add(0, kNaN);
  rays.add({0, 0, -5}, {0, 0, -1}, -kInf, 0);
  rays.add({0, 0, -5}, {0, 0, -1}, 0, kInf);
  const float wanted[] = {4, 0, 0, 6, 4, 0, 0, 0, 0, 0, -6, 0};  // 0: nothing
  for (const Way& way : every_way()) {
    const Answers a = trace(variant(), world, rays, way.settings, Query::kClosest);
    const Answers o = trace(variant(), world, rays, way.settings, Query::kOccluded);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(a.id[i] != kNoPrimitive, wanted[i] != 0) << way.name << ", " << rays.describe(i);
      EXPECT_EQ(o.id[i] != kNoPrimitive, wanted[i] != 0) << way.name << ", " << rays.describe(i);
      if (wanted[i] != 0) {
        EXPECT_EQ(a.t[i], wanted[i]) << way.name << ", " << rays.describe(i);
        EXPECT_EQ(o.t[i], -kInf) << way.name << ", " << rays.describe(i);
      }
    }
  }
}

}  // namespace
}  // namespace grelha::test
