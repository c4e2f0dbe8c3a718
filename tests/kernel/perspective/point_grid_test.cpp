// Grids in perspective: whatever the scene and wherever the point, they answer as the scene's own
// grids do.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "grelha/grelha.hpp"
#include "kernel/query/variants.hpp"
#include "kernel/world/world_impl.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

constexpr int kPoints = 4000;

Float3 float3(const double (&p)[3]) {
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

Float3 between(const Float3& a, const Float3& b, double share) {
  return {static_cast<float>(a.x + (b.x - a.x) * share),
          static_cast<float>(a.y + (b.y - a.y) * share),
          static_cast<float>(a.z + (b.z - a.z) * share)};
}

/// Points that ask: anywhere, on surfaces, beyond corners of triangles as the point sees them, and
/// on the borders of the cube's faces around it; half of them many side by side, which are looked
/// up together.
class Askers {
 public:
  Askers(const World& world, const Scene& scene, const Float3& point, std::uint64_t seed)
      : world_(world), scene_(scene), point_(point), random_(seed) {
    for (int i = 0; i < kPoints; ++i)
      points.push_back(i % 64 < 32 ? next(i % 4) : near(points[points.size() - 1 - i % 32]));
  }
  std::vector<Float3> points;

 private:
  Float3 next(int kind) {
    const Float3 any = random_.point(random_.chance(.2) ? random_.log_in(3, 3000) : 1.5);
    if (kind == 1)
      return on_surface(any);
    if (kind == 2 && scene_.geometry.triangles.size() > 0)
      return behind_edge();
    if (kind == 3)
      return on_border();
    return any;
  }
  Float3 near(const Float3& p) {
    const Float3 d = random_.direction();
    const double size = random_.log_in(1e-4, .3);
    return {static_cast<float>(p.x + size * d.x),
            static_cast<float>(p.y + size * d.y),
            static_cast<float>(p.z + size * d.z)};
  }
  Float3 on_surface(const Float3& org) {
    const Ray ray{org, random_.direction()};
    const Hit hit = closest(world_, ray);
    if (!hit)
      return org;
    const SurfacePoint s = surface(world_, ray, hit);
    return s.leave({point_.x - s.point.x, point_.y - s.point.y, point_.z - s.point.z});
  }
  Float3 behind_edge() {
    const Triangles& t = scene_.geometry.triangles;
    const std::uint32_t i = random_.below(static_cast<std::uint32_t>(t.size()));
    const auto corner = [&](std::uint32_t v) { return Float3{t.x[v], t.y[v], t.z[v]}; };
    const double share = random_.chance(.3) ? 0 : random_.unit();
    const double away = random_.chance(.5) ? random_.in(.9, 3) : random_.log_in(3, 1000);
    return between(point_, between(corner(t.a[i]), corner(t.b[i]), share), away);
  }
  Float3 on_border() {
    const float along = static_cast<float>(random_.log_in(.1, 10));
    const float x = static_cast<float>(random_.sign()) * along;
    const float y = static_cast<float>(random_.sign()) * along;
    const float z = static_cast<float>(random_.in(-1, 1)) * along;
    const int turn = static_cast<int>(random_.below(3));
    const float c[3] = {x, y, z};
    return {point_.x + c[turn], point_.y + c[(turn + 1) % 3], point_.z + c[(turn + 2) % 3]};
  }
  const World& world_;
  const Scene& scene_;
  Float3 point_;
  Random random_;
};

std::vector<Ray> rays_to(const Float3& point, const std::vector<Float3>& from) {
  std::vector<Ray> rays;
  for (const Float3& p : from)
    rays.push_back({p, {point.x - p.x, point.y - p.y, point.z - p.z}, 0, 1});
  return rays;
}

/// Asks with every instruction set. Returns how many are blocked.
long expect_same(const World& world, const Float3& point, const std::vector<Float3>& from) {
  const PointGrid grid(world, point, 2);
  const std::vector<Ray> rays = rays_to(point, from);
  std::vector<std::uint8_t> wanted(rays.size());
  occluded(world, rays, wanted);
  for (const Isa& isa : isas()) {
    if (!isa.compiled || !isa.runs_here)
      continue;
    std::vector<std::uint8_t> found(rays.size(), 7);
    occluded(grid, Points::of(from), found.data(), {.packet = 256, .isa = isa.name});
    int wrong = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
      wrong += found[i] != wanted[i];
    EXPECT_EQ(wrong, 0) << isa.name << ", point " << point.x << ' ' << point.y << ' ' << point.z;
  }
  return std::count(wanted.begin(), wanted.end(), std::uint8_t{1});
}

long expect_same(const World& world, const Scene& scene, const Float3& point, std::uint64_t seed) {
  return expect_same(world, point, Askers(world, scene, point, seed).points);
}

struct Family {
  const char* name;
  std::function<Scene()> make;
};

/// Triangles whose planes hold the point (2, 3, 1) to the last bit, though products round.
Scene seen_from_the_edge() {
  Random random(14);
  Scene s = empty_scene();
  const auto number = [&] { return std::floor(random.in(-2, 2) * 0x1p20) * 0x1p-20; };
  const double light[3] = {2, 3, 1};
  for (int i = 0; i < 300; ++i) {
    double a[3], b[3], c[3];
    for (int k = 0; k < 3; ++k) {
      a[k] = number();
      b[k] = number();
      c[k] = a[k] + b[k] - light[k];
    }
    add_triangle(s, float3(a), float3(b), float3(c));
  }
  return s;
}

const Family kFamilies[] = {
    {"spheres", [] { return random_spheres(1, 300); }},
    {"triangles", [] { return random_triangles(2, 500); }},
    {"cones", [] { return random_cones(3, 200); }},
    {"mixture", [] { return random_mixture(4, 600); }},
    {"flat sheet", [] { return flat_sheet(5, 300); }},
    {"lattice",
     [] {
       return placed(lattice_patch(16), .1, {-.8f, 0, -.8f});
     }},
    {"heap", [] { return heap(6, 40); }},
    {"needles", [] { return needles(7, 200); }},
    {"crowd on a plain", [] { return crowd_on_a_plain(8, 800, 40); }},
    {"crowd on a wide plain", [] { return crowd_on_a_wide_plain(9, 400); }},
    {"stadium", [] { return stadium(10, 400); }},
    {"towns", [] { return towns_in_a_desert(11, 300); }},
    {"seen from the edge", [] { return seen_from_the_edge(); }},
    {"moved away",
     [] {
       return placed(random_mixture(12, 300), 1, {4000, -900, 2e4f});
     }},
    {"tiny",
     [] {
       return placed(random_mixture(13, 300), 1e-4, {0, 0, 0});
     }},
};

class PointGrids : public testing::TestWithParam<Family> {};

/// Lights around, within, on things and far away.
std::vector<Float3> lights(const Scene& scene, Random& random) {
  std::vector<Float3> all{{2, 3, 1}, {0, 0, 0}, {.3f, -.2f, .1f}, {0, 5, 0}, {-700, 900, 100}};
  all.push_back({1e6f, 2e6f, -1e6f});
  all.push_back({0, -1e9f, 0});
  const Geometry& g = scene.geometry;
  if (g.triangles.size() > 0)
    all.push_back({g.triangles.x[0], g.triangles.y[0], g.triangles.z[0]});
  if (g.spheres.size() > 0)
    all.push_back({g.spheres.x[0], g.spheres.y[0], g.spheres.z[0]});
  if (g.cones.size() > 0)
    all.push_back({g.cones.base_x[0], g.cones.base_y[0], g.cones.base_z[0]});
  all.push_back(random.point(1));
  return all;
}

TEST_P(PointGrids, AnswerAsTheScenesGridsDo) {
  const Scene scene = GetParam().make();
  const World world(scene, {});
  Random random(99);
  long blocked = 0;
  std::uint64_t seed = 0;
  for (const Float3& light : lights(scene, random))
    blocked += expect_same(world, scene, light, ++seed);
  EXPECT_GT(blocked, 100) << "what is asked is never hidden";
}

INSTANTIATE_TEST_SUITE_P(Families,
                         PointGrids,
                         testing::ValuesIn(kFamilies),
                         [](const auto& family) {
                           std::string name = family.param.name;
                           std::erase(name, ' ');
                           return name;
                         });

std::unique_ptr<ViewedGrid> build(const World& world,
                                  const Float3& at,
                                  int threads,
                                  const Variant& variant = best_variant()) {
  return world.impl().light_grids->build(at, threads, variant.loops.look);
}

bool same_lists(const PerspectiveGrid& a, const PerspectiveGrid& b) {
  if (a.tiles != b.tiles || a.around != b.around)
    return false;
  bool same = true;
  for (std::uint32_t r = 0; r < a.tiles.back().first[kOutlineList]; ++r)
    same &=
        a.outlines[r / kOutlines].id[r % kOutlines] == b.outlines[r / kOutlines].id[r % kOutlines];
  for (std::uint32_t r = 0; r < a.tiles.back().first[kBoxList]; ++r)
    same &= a.boxes[r / kOutlines].id[r % kOutlines] == b.boxes[r / kOutlines].id[r % kOutlines];
  return same;
}

Float3 moved(const Float3& p, double along, const Float3& way) {
  return {static_cast<float>(p.x + along * way.x),
          static_cast<float>(p.y + along * way.y),
          static_cast<float>(p.z + along * way.z)};
}

/// A place around an axis, one away from it.
Float3 on_ring(Random& random, const Float3& axis) {
  const Float3 d = random.direction();
  const double along = d.x * axis.x + d.y * axis.y + d.z * axis.z;
  const Float3 across = moved(d, -along, axis);
  const double size = std::sqrt(1 - along * along);
  return moved({0, 0, 0}, 1 / size, across);
}

/// Walls along the way from a light so far away that doubles hardly tell which side of their edges
/// it is on; rays pass close by these.
TEST(PointGrid, FindsWallsThatPointAtAFarLight) {
  for (const double far : {1e4, 1e5, 3e5, 6e5, 9e5, 1.5e6}) {
    Random random(29);
    const Float3 way = random.direction();
    Scene scene = empty_scene();
    std::vector<Float3> points;
    for (int i = 0; i < 300; ++i) {
      const Float3 a = on_ring(random, way);
      const Float3 c = moved(a, .2, on_ring(random, way));
      add_triangle(scene, a, moved(a, 1, way), c);
      for (int k = 0; k < 30; ++k) {
        const Float3 beside = between(a, c, random.log_in(1e-7, 1));
        points.push_back(moved(beside, random.in(-1, 1), way));
      }
    }
    const World world(scene, {});
    expect_same(world, moved({0, 0, 0}, far, way), points);
  }
}

TEST(PointGridLists, AreTheSameForAnyNumberOfThreads) {
  const Scene scene = random_mixture(21, 3000);
  const World world(scene, {});
  const Float3 at{.5f, 2, .1f};
  const auto one = build(world, at, 1);
  ASSERT_TRUE(one);
  for (const int threads : {2, 3, 7})
    EXPECT_TRUE(same_lists(one->grid, build(world, at, threads)->grid)) << threads << " threads";
}

TEST(PointGridLists, AreTheSameForEveryInstructionSet) {
  const Scene scene = random_mixture(28, 3000);
  const World world(scene, {});
  const Float3 at{.5f, 2, .1f};
  const auto one = build(world, at, 1);
  ASSERT_TRUE(one);
  for (const Variant* variant : variants()) {
    if (!variant->runs_here())
      continue;
    EXPECT_TRUE(same_lists(one->grid, build(world, at, 1, *variant)->grid)) << variant->name;
  }
}

TEST(PointGridLists, PartCrowdedTiles) {
  Random random(22);
  Scene scene = empty_scene();
  add_spheres(scene, random, 200, 1000, 1, 2);
  add_spheres(scene, random, 2000, 30, .3, .6);
  const World world(scene, {});
  const auto built = build(world, {0, 3000, 0}, 2);
  ASSERT_TRUE(built);
  const auto has_parts = [](const TileLists& t) { return t.columns > 0; };
  EXPECT_TRUE(std::ranges::any_of(built->grid.tiles, has_parts));
}

TEST(PointGridLists, StayFewWhereNeedlesSpanAllTiles) {
  const Scene scene = needles(23, 300);
  const World world(scene, {});
  const auto built = build(world, {0, 4, 0}, 2);
  ASSERT_TRUE(built);
  EXPECT_LT(built->grid.references(), 100u * 300u);
}

/// Room for rays from afar would be as wide as they are.
TEST(PointGridLists, StayFewWherePrimitivesAreSmallInTheirScene) {
  Random random(27);
  Scene scene = empty_scene();
  add_triangles(scene, random, 4000, 1, .01, .02);
  scene.geometry.spheres.add({1500, 0, 0}, 1, 0);
  const World world(scene, {});
  const auto built = build(world, {0, 9, 0}, 2);
  ASSERT_TRUE(built);
  EXPECT_LE(built->grid.references(), 2u * 4000u);
  expect_same(world, scene, {0, 9, 0}, 4);
}

Scene heap_of_spheres(double least, double most) {
  Random random(26);
  Scene scene = empty_scene();
  add_spheres(scene, random, 4000, 1, least, most);
  return scene;
}

TEST(PointGridLists, StayFewWherePrimitivesCoverEachOther) {
  const Scene scene = heap_of_spheres(.06, .12);
  const World world(scene, {});
  const auto built = build(world, {0, 9, 0}, 2);
  ASSERT_TRUE(built);
  EXPECT_LE(built->grid.references(), 70u * 4000u);
  expect_same(world, scene, {0, 9, 0}, 3);
}

TEST(PointGridLists, AreNotPutTogetherOfHeaps) {
  const Scene scene = heap_of_spheres(.5, .9);
  const World world(scene, {});
  EXPECT_FALSE(build(world, {0, 9, 0}, 2));
  expect_same(world, scene, {0, 9, 0}, 3);
}

/// Thousands of specks that rays from afar cannot tell apart: in each part of their tile all stand.
TEST(PointGridLists, AreNotPutTogetherOfSpecksInOnePlace) {
  const Scene scene = towns_in_a_desert(22, 4000);
  const World world(scene, {});
  EXPECT_FALSE(build(world, {0, 3000, 0}, 2));
  expect_same(world, scene, {0, 3000, 0}, 3);
}

TEST(PointGrid, RefusesWhatIsNoPoint) {
  const Scene scene = random_spheres(24, 20);
  const World world(scene, {});
  EXPECT_THROW(PointGrid(world, {0, kNaN, 0}), std::invalid_argument);
  EXPECT_THROW(PointGrid(world, {0, 0, 0}, -1), std::invalid_argument);
  const PointGrid grid(world, {0, 0, 3});
  const Float3 point{1, 2, 3};
  std::uint8_t blocked = 0;
  EXPECT_THROW(occluded(grid, {.count = 1}, &blocked), std::invalid_argument);
  EXPECT_THROW(occluded(grid, Points::of({&point, 1}), nullptr), std::invalid_argument);
  occluded(grid, {}, nullptr);
}

TEST(PointGrid, TooFarAwayWalks) {
  const Scene scene = random_spheres(25, 20);
  const World world(scene, {});
  EXPECT_EQ(PointGrid(world, {1e30f, 0, 0}).bytes(), 0u);
  expect_same(world, scene, {1e30f, 0, 0}, 1);
}

/// The caller's array ends with the points, where groups of lanes do not (what is read beyond it
/// shows under the address sanitizer).
TEST(PointGrid, ReadsNoMoreLeavesThanPoints) {
  Scene scene = empty_scene();
  scene.geometry.spheres.add({0, 0, 0}, 1, 0);
  const World world(scene, {});
  const PointGrid grid(world, {0, 0, 4});
  const Float3 points[] = {{0, 0, 1.01f}, {0, 0, -2}, {3, 0, -2}};
  const std::vector<std::uint32_t> leaves{0, kNoPrimitive, 0};
  Points to = Points::of(points);
  to.leaves = leaves.data();
  std::uint8_t blocked[3];
  occluded(grid, to, blocked);
  EXPECT_EQ(blocked[0], 0);
  EXPECT_EQ(blocked[1], 1);
  EXPECT_EQ(blocked[2], 0);
}

TEST(PointGrid, OfAnEmptyWorldSeesEverything) {
  const Scene scene = empty_scene();
  const World world(scene, {});
  const PointGrid grid(world, {0, 0, 0});
  const Float3 points[] = {{1, 2, 3}, {0, 0, 0}, {kNaN, 1, kInf}};
  std::uint8_t blocked[] = {7, 7, 7};
  occluded(grid, Points::of(points), blocked);
  for (const std::uint8_t b : blocked)
    EXPECT_EQ(b, 0);
}

}  // namespace
}  // namespace grelha::test
