// Every way through a grid against brute force: the same primitive and the same bits of t, whatever
// the scene and the ray.
#include <optional>

#include "tests/support/cell_rays.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

struct Place {
  double scale = 1;
  Float3 offset{};
};

struct Case {
  std::string name;
  Scene (*make)();
  double size;  ///< half the extent rays are aimed over
  Float3 center{};
  std::optional<Place> place{};  ///< where the scene is moved to; none: as it is made
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

template <auto Make, int Count>
Scene crowd() {
  return Make(7, Count);
}
/// Three grids one behind another: what is left of a packet's rays after one goes on through the
/// next.
Scene objects_in_a_row() {
  Scene s = random_spheres(8, 60);
  for (int i = 0; i < 2; ++i) {
    const Scene ball =
        placed(ball_mesh(24, 12, .3, 5), .9, {i - .5f, 0, .25f * static_cast<float>(i)});
    add_object(s, ball);
  }
  return s;
}

Scene one_sphere_many_times() {
  Scene s = empty_scene();
  for (int i = 0; i < 50; ++i)
    s.geometry.spheres.add({1, 2, 3}, .5f, 0);
  return s;
}

Scene points() {
  Scene s = empty_scene();
  for (int i = 0; i < 40; ++i)
    s.geometry.spheres.add({}, 1e-12f, 0);
  return s;
}

Scene sheets() {
  return stacked_sheets(300);
}

Scene lattice() {
  return lattice_patch(12);
}
Scene closed_ball() {
  return ball_mesh(24, 12, .2);
}
Scene smooth_ball() {
  return ball_mesh(24, 12);
}

/// Skins of an onion among sheets of paper: a ray passes more of a cell's primitives than any other
/// scene has there.
Scene layers() {
  Scene s = empty_scene();
  for (int i = 0; i < 200; ++i)
    s.geometry.spheres.add({}, .2f + .004f * static_cast<float>(i), 0);
  for (int i = 0; i < 1500; ++i) {
    const float y = .001f * static_cast<float>(i) - .75f;
    add_triangle(s, {-.4f, y, -.4f}, {.4f, y, -.4f}, {0, y, .6f});
  }
  return s;
}

constexpr auto kSpheres = crowd<random_spheres, 300>;
constexpr auto kTriangles = crowd<random_triangles, 300>;
constexpr auto kCones = crowd<random_cones, 200>;
constexpr auto kMixture = crowd<random_mixture, 300>;
constexpr auto kStadium = crowd<stadium, 400>;
constexpr auto kPlain = crowd<crowd_on_a_wide_plain, 400>;

constexpr Float3 k1e3{1000, -500, 2000}, k1e4{1e4f, 2e4f, -1e4f}, k1e5{1e5f, 1e5f, 1e5f};
constexpr Float3 kFewUlps{148376, 1234, -223423};

const std::vector<Case> kCases{
    {"spheres", kSpheres, 1},
    {"triangles", kTriangles, 1},
    {"cones", kCones, 1},
    {"mixture", kMixture, 1},
    {"flat", crowd<flat_sheet, 200>, 1, {0, .25f, 0}},
    {"lattice", lattice, 6, {6, 1, 6}},
    {"sheets", sheets, 1, {.5f, .5f, .5f}},
    {"heap", crowd<heap, 20>, 1},
    {"needles", crowd<needles, 150>, 1},
    {"stadium", kStadium, 1},
    {"towns", crowd<towns_in_a_desert, 2000>, 3, {-300, 100, 50}},
    {"stadium_seen_from_the_stands", kStadium, 900},
    {"wide_plain", kPlain, 1},
    {"wide_plain_seen_from_all_over", kPlain, 300},
    {"mesh_in_a_vast_scene", mesh_in_a_vast_scene, 1},
    {"one_sphere_many_times", one_sphere_many_times, 1, {1, 2, 3}},
    {"points", points, 1e-12},
    {"layers", layers, 1},
    {"tiny", kMixture, 1e-6, {}, Place{1e-6}},
    {"huge", kMixture, 1e6, {}, Place{1e6}},
    {"far_1e3", kMixture, 1, k1e3, Place{1, k1e3}},
    {"far_1e4", kMixture, 1, k1e4, Place{1, k1e4}},
    {"few_ulps_a_cell", kMixture, 2, kFewUlps, Place{2, kFewUlps}},
    {"far_spheres", kSpheres, 1, k1e5, Place{1, k1e5}},
    {"far_lattice", lattice, 6, {65542, 1, -131066}, Place{1, {65536, 0, -131072}}},
    {"objects_in_a_row", objects_in_a_row, 1.5},
    {"closed_ball", closed_ball, 1},
    {"closed_ball_far", smooth_ball, 1, {3e4f, 0, 0}, Place{1, {3e4f, 0, 0}}},
};

/// Neighbours that point nearly the same way, so that packets stay together: an eye ray's case.
/// Some bundles cross an axis.
RayList coherent_rays(Random& random, const Float3& center, double size, int bundles) {
  RayList rays;
  for (int b = 0; b < bundles; ++b) {
    const Float3 eye = at(center, size * random.log_in(.3, 20), random.direction());
    const Float3 aim = at(center, size * random.unit(), random.direction());
    Float3 main = minus(aim, eye);
    if (b % 4 == 0)
      main = {0, 0, static_cast<float>(b % 8 == 0 ? size : -size)};
    const double spread = random.log_in(1e-3, 1) * size;
    for (int i = 0; i < 64; ++i)
      rays.add(eye, at(main, spread, random.point(1)));
  }
  return rays;
}

class Walk : public testing::TestWithParam<std::tuple<const Variant*, Case>> {
 protected:
  void SetUp() override {
    if (!variant().is_supported())
      GTEST_SKIP() << "this processor has no " << variant().name;
  }
  static const Variant& variant() { return *std::get<0>(GetParam()); }
};

TEST_P(Walk, FindsWhatBruteForceFinds) {
  const Case& c = std::get<1>(GetParam());
  const Scene scene = c.place ? placed(c.make(), c.place->scale, c.place->offset) : c.make();
  Random random(99);
  RayList rays = rays_about(random, c.center, c.size, kManyRays, 1e6);
  rays.add(with_odd_values(random, rays_about(random, c.center, c.size, 300), .3));
  rays.add(coherent_rays(random, c.center, c.size, 24));
  std::size_t grids = 0;
  for (const float density : {.5f, 1.f, 2.f, 4.f}) {
    const World world(scene, {.density = density});
    grids += world.impl().grids.size();
    RayList all = rays;
    all.add(rays_on_cells(random, world, 500));
    const Truth truth = truth_of(scene, all);
    EXPECT_GT(hits_of(truth.closest), 30u);
    std::ostringstream what;
    what << c.name << ", density " << density;
    expect_truth(variant(), world, all, truth, what.str());
    if (HasFailure())
      return;
  }
  EXPECT_GT(grids, 0u) << "no grid was built: nothing was walked";
}

INSTANTIATE_TEST_SUITE_P(Isa,
                         Walk,
                         testing::Combine(testing::ValuesIn(variants().begin(), variants().end()),
                                          testing::ValuesIn(kCases)),
                         [](const auto& p) {
                           return std::string(std::get<0>(p.param)->name) + "_" +
                                  std::get<1>(p.param).name;
                         });

/// From so far away that floats would be off by more than the cells are wide.
TEST(FarRays, FindWhatBruteForceFinds) {
  const Scene scene = crowd_on_a_wide_plain(7, 400);
  const World world(scene, {.density = 4});
  Random random(3);
  RayList rays;
  for (int i = 0; i < 20000; ++i) {
    const Float3 eye = at({}, random.log_in(1e4, 2e6), random.direction()), aim = random.point(1);
    rays.add({eye.x, std::abs(eye.y), eye.z}, minus(aim, {eye.x, std::abs(eye.y), eye.z}));
  }
  const Truth truth = truth_of(scene, rays);
  std::size_t met = 0;
  for (const std::uint32_t id : truth.closest.id)
    met += id < 400u + 50u;
  EXPECT_GT(met, 2000u);
  expect_truth(*find_variant("best"), world, rays, truth, "far rays");
}

/// Sheets of paper in the middle of a vast scene, the lowest first.
Scene pages_in_a_vast_scene() {
  Scene pages = empty_scene();
  for (int sheet = 0; sheet < 20; ++sheet)
    for (int i = 0; i < 64; ++i) {
      const auto at = [&](int x, int z) {
        return Float3{.25f * static_cast<float>(x - 4),
                      .03f * static_cast<float>(sheet) - .3f,
                      .25f * static_cast<float>(z - 4)};
      };
      const int x = i % 8, z = i / 8;
      add_triangle(pages, at(x, z), at(x + 1, z), at(x + 1, z + 1));
      add_triangle(pages, at(x, z), at(x + 1, z + 1), at(x, z + 1));
    }
  return in_a_vast_scene(pages);
}

class FarRays : public EveryVariant {};
GRELHA_FOR_EVERY_ISA(FarRays);

/// Includes rays that end or start within a few units in the last place of a surface. If sheets
/// have equal t from afar, the hit is the sheet with the lowest id, which lies behind others.
TEST_P(FarRays, MeetMeshesOfTheirOwnScale) {
  for (const Scene& scene : {mesh_in_a_vast_scene(), pages_in_a_vast_scene()}) {
    const World world(scene, {});
    ASSERT_EQ(world.impl().grids.size(), 1u);
    Random random(4);
    RayList rays;
    for (int i = 0; i < 2000; ++i) {
      const Float3 from = random.direction();
      const Float3 eye = at({}, random.log_in(100, 2e6), {from.x, std::abs(from.y), from.z});
      rays.add(eye, scaled(minus(random.point(1), eye), random.log_in(1e-3, 1e3)));
    }
    const Answers met = truth_of(scene, rays).closest;
    std::size_t of_mesh = 0;
    for (std::size_t i = 0; i < met.id.size(); ++i) {
      of_mesh += met.id[i] < scene.geometry.objects[0].triangle_count;
      const double error = random.sign() * random.log_in(0x1p-25, 0x1p-18);
      const auto t = static_cast<float>(met.t[i] * (1 + error));
      const bool ends = random.chance(.5);
      rays.add(rays.org(i), rays.dir(i), ends ? 0 : t, ends ? t : kInf);
    }
    EXPECT_GT(of_mesh, 500u);
    expect_truth(*GetParam(), world, rays, truth_of(scene, rays), "rays from afar");
  }
}

/// So small beside the scene that its cells are as wide as what doubles make of places out there.
/// Rays through its middle alone are floats.
TEST_P(FarRays, MeetASpeck) {
  Scene scene = placed(mesh_in_a_vast_scene(), 1e-3, {});
  Triangles& t = scene.geometry.triangles;
  for (std::size_t corner = t.x.size() - 6; corner < t.x.size(); ++corner) {
    t.x[corner] *= 1e11f;
    t.z[corner] *= 1e11f;
  }
  Random random(6);
  RayList rays;
  for (int i = 0; i < 800; ++i) {
    const auto way = [&] { return static_cast<float>(random.below(200)) - 99.5f; };
    const Float3 from{way(), 1 + std::abs(way()), way()};
    rays.add(scaled(from, 0x1p35), scaled(from, -1));
  }
  const World world(scene, {});
  const Truth truth = truth_of(scene, rays);
  EXPECT_EQ(hits_of(truth.closest), 800u);
  expect_truth(*GetParam(), world, rays, truth, "rays through a speck");
}

/// Meshes hidden behind another mesh add no tests to closest hits, in whatever order meshes are
/// listed.
TEST(GridOrder, IsFrontToBack) {
  std::uint64_t tests[2] = {};
  for (const bool near_first : {true, false}) {
    Scene s = empty_scene();
    for (int i = 0; i < 3; ++i) {
      const Scene ball = placed(
          ball_mesh(24, 12),
          1,
          {0, 0, near_first ? -3.f * static_cast<float>(i) : 3.f * static_cast<float>(i - 2)});
      add_object(s, ball);
    }
    const World world(s, {});
    ASSERT_EQ(world.impl().grids.size(), 3u);
    RayList rays;
    for (int i = 0; i < 64; ++i)
      rays.add({0, 0, 9},
               {.004f * static_cast<float>(i % 8 - 4), .004f * static_cast<float>(i / 8 - 4), -1});
    for (const int packet : {64, 1}) {
      const Answers a = trace(*find_variant("best"), world, rays, {packet, true}, Query::kClosest);
      EXPECT_EQ(hits_of(a), 64u);
      tests[near_first] += a.counts.tests.triangle;
    }
  }
  EXPECT_EQ(tests[0], tests[1]);
}

class Ties : public EveryVariant {};
GRELHA_FOR_EVERY_ISA(Ties);

/// Of copies at the same place the lower id is hit, with every method, in any order of cells; and
/// of different kinds at equal t too: planes, spheres, triangles, cones.
TEST_P(Ties, TheLowerIdWins) {
  Scene scene = empty_scene();
  for (int copy = 0; copy < 3; ++copy)
    for (int z = 0; z < 6; ++z)
      for (int x = 0; x < 6; ++x) {
        const float a = static_cast<float>(x), b = static_cast<float>(z);
        add_triangle(scene, {a, 0, b}, {a + 1, 0, b}, {a + 1, 0, b + 1});
        add_triangle(scene, {a, 0, b}, {a + 1, 0, b + 1}, {a, 0, b + 1});
        scene.geometry.spheres.add({a + .5f, 0, b + .5f}, .25f, 0);
      }
  // a triangle that covers all others, added later and in no grid
  add_triangle(scene, {-3, 0, -3}, {9, 0, -3}, {3, 0, 9});
  Random random(5);
  RayList rays;
  for (int i = 0; i < 2048; ++i) {
    const Float3 aim{static_cast<float>(random.below(24)) * .25f,
                     0,
                     static_cast<float>(random.below(24)) * .25f};
    rays.add(
        random.chance(.5)
            ? Float3{aim.x, 4, aim.z}
            : at(aim,
                 4,
                 {random.below(3) - 1.f, random.chance(.5) ? 1.f : -1.f, random.below(3) - 1.f}),
        {0, 0, 0});
    const Float3 d = minus(aim, rays.org(rays.size() - 1));
    rays.dx.back() = d.x;
    rays.dy.back() = d.y;
    rays.dz.back() = d.z;
  }
  for (const float density : {.5f, 1.f, 3.f}) {
    const World world(scene, {.density = density});
    ASSERT_FALSE(world.impl().grids.empty());
    const Truth truth = truth_of(scene, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (truth.closest.id[i] == kNoPrimitive)
        continue;
      // never a second or third copy of a triangle
      EXPECT_LT(truth.closest.id[i], 3 * 36u + 72) << rays.describe(i);
      if (truth.closest.id[i] < 108u) {
        EXPECT_LT(truth.closest.id[i], 36u) << rays.describe(i);
      }
    }
    expect_truth(variant(), world, rays, truth, "ties");
  }
}

TEST_P(Ties, KindsComeInTheOrderOfTheirIds) {
  Scene scene = empty_scene();
  // its side touches y = 1 along x, z = 1
  scene.geometry.cones.add({-1, 0, 1}, 1, {1, 0, 1}, 1, 0);
  scene.geometry.spheres.add({0, 0, 1}, 1, 0);
  add_triangle(scene, {-5, 1, -5}, {5, 1, -5}, {0, 1, 9});
  RayList rays;
  rays.add({0, 3, 1}, {0, -1, 0});
  for (int planes = 1; planes >= 0; --planes) {
    if (planes)
      scene.geometry.planes.add({0, 1, 0}, {0, 1, 0}, 0);
    else
      scene.geometry.planes = {};
    const World world(scene, {});
    for (const Way& way : every_way()) {
      const Answers a = trace(variant(), world, rays, way.settings, Query::kClosest);
      EXPECT_EQ(a.t[0], 2.f) << way.name;
      EXPECT_EQ(a.id[0], 0u) << way.name;  // the plane; without it the sphere
    }
  }
}

}  // namespace
}  // namespace grelha::test
