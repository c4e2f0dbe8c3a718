// Exact copies of primitives are not tested, and nothing shows that they are not.
#include "grelha/render.hpp"
#include "kernel/shapes/primitives.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "kernel/world/world_impl.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

#include <gtest/gtest.h>

namespace grelha::test {
namespace {

constexpr std::uint32_t kCopies = 2000;

/// One of each kind many times over, each time of another material, among others.
Scene with_copies(std::uint32_t copies) {
  Scene s = random_mixture(5, 40);
  s.materials.resize(1);
  for (std::uint32_t k = 0; k < copies; ++k) {
    Material m;
    m.diffuse = {k == 0 ? 1.f : 0.f, k == 0 ? .5f : 1.f, .2f};
    s.materials.push_back(m);
    const std::uint32_t material = k + 1;
    s.geometry.spheres.add({.1f, .2f, .3f}, .4f, material);
    add_triangle(s, {-2, -2, 0}, {2, -1, .2f}, {0, 2, 0}, material);
    s.geometry.cones.add({1, -1, 0}, .5f, {1, 1, 0}, .2f, material);
    s.geometry.planes.add({0, -3, 0}, {0, 1, 0}, material);
  }
  s.lights = {{{3, 5, 5}, {1, 1, 1}, {}, {}}};
  return s;
}

Image picture(const Scene& scene, const BuildOptions& build, RenderStats& stats) {
  Camera c;
  c.eye = {0, 1, 6};
  c.width = c.height = 48;
  return render(World(scene, build), c, {}, stats);
}

TEST(Copies, AreNeitherSeenNorTested) {
  RenderStats stats, stats_of_one;
  const Scene many = with_copies(kCopies), one = with_copies(1);
  const Image seen = picture(many, {}, stats);
  EXPECT_EQ(seen.rgb, picture(one, {}, stats_of_one).rgb);
  const auto tests = [](const RenderStats& s) {
    return s.trace.tests.sphere + s.trace.tests.triangle + s.trace.tests.cone + s.trace.tests.plane;
  };
  EXPECT_LT(tests(stats), 10 * tests(stats_of_one));
  BuildOptions listed;
  listed.grid = false;
  EXPECT_EQ(seen.rgb, picture(many, listed, stats).rgb);
}

TEST(Copies, GoTheSameForEveryNumberOfThreads) {
  const Scene scene = with_copies(kCopies);
  std::vector<std::uint64_t> references;
  for (const int threads : {1, 2, 3}) {
    BuildOptions build;
    build.threads = threads;
    std::uint64_t sum = 0;
    for (const GridStats& g : World(scene, build).grids())
      sum += g.references;
    references.push_back(sum);
  }
  EXPECT_EQ(references[0], references[1]);
  EXPECT_EQ(references[0], references[2]);
}

TEST(Copies, AreEqualToTheBit) {
  Scene s;
  s.materials.resize(1);
  for (const float x : {1.f, 0.f, 1.f, -0.f, 0.f})
    s.geometry.spheres.add({x, 0, 0}, 2, 0);
  add_triangle(s, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_triangle(s, {1, 0, 0}, {0, 1, 0}, {0, 0, 0});  // from another corner: t may round otherwise
  add_triangle(s, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});  // of vertices of its own
  for (int k = 0; k < 2; ++k)
    s.geometry.cones.add({0, 0, 0}, 1, {0, 1, 0}, .5f, 0);
  const Primitives p(s.geometry);
  std::vector<std::uint32_t> ids;
  for (std::uint32_t id = 0; id < p.ids.end(); ++id)
    ids.push_back(id);
  std::vector<Copy> copies = find_duplicates(p, ids);
  std::sort(copies.begin(), copies.end());
  EXPECT_EQ(copies, (std::vector<Copy>{{0, 2}, {1, 4}, {5, 7}, {8, 9}}));
}

/// The words that a sphere's hash sees, one changed so that its upper half stays, the next so that
/// the lower half does: FNV-1a of both is the same.
TEST(Copies, AreNotTakenForEqualSinceTheirHashesAre) {
  constexpr std::uint64_t kPrime = 0x100000001B3u;
  constexpr std::uint64_t kStart = 0xCBF29CE484222325u;
  Random random(4);
  int found = 0;
  for (int i = 0; i < 1000 && found < 10; ++i) {
    const auto x = std::bit_cast<std::uint32_t>(static_cast<float>(random.in(-2, -1)));
    const auto y = std::bit_cast<std::uint32_t>(static_cast<float>(random.in(1, 2)));
    const std::uint64_t seen = kStart ^ x;
    const std::uint64_t other_seen = seen + (151u << 24) - 1;
    const std::uint64_t state = seen * kPrime;
    const std::uint64_t other_state = other_seen * kPrime;
    const auto other_x = static_cast<std::uint32_t>(kStart ^ other_seen);
    const auto other_y = static_cast<std::uint32_t>(y ^ state ^ other_state);
    const auto other_at = Float3{std::bit_cast<float>(other_x), std::bit_cast<float>(other_y), 0};
    if (state >> 32 != other_state >> 32 || !std::isfinite(other_at.x) ||
        !std::isfinite(other_at.y))
      continue;
    ++found;
    Scene s;
    s.materials.resize(1);
    s.geometry.spheres.add({std::bit_cast<float>(x), std::bit_cast<float>(y), 0}, 1, 0);
    s.geometry.spheres.add(other_at, 1, 0);
    const Primitives p(s.geometry);
    EXPECT_TRUE(find_duplicates(p, std::vector<std::uint32_t>{0, 1}).empty());
  }
  EXPECT_EQ(found, 10);
}

TEST(Copies, OfPlanesAtTheEndAreNotTested) {
  Planes planes;
  for (const float y : {0.f, 1.f, 0.f, 2.f, 1.f, 0.f})
    planes.add({0, y, 0}, {0, 1, 0}, 0);
  EXPECT_EQ(find_last_copies(planes), (std::vector<Copy>{{1, 4}, {0, 5}}));
  EXPECT_TRUE(find_last_copies(Planes{}).empty());
}

TEST(PrimitiveIds, SayWhichPrimitiveTheyAre) {
  Scene s;
  for (const float y : {0.f, 1.f})
    s.geometry.planes.add({0, y, 0}, {0, 1, 0}, 0);
  // no spheres
  for (const float x : {0.f, 1.f, 2.f})
    add_triangle(s, {x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0});
  s.geometry.cones.add({0, 0, 0}, 1, {0, 1, 0}, .5f, 0);
  const Primitives p(s.geometry);
  const Primitive wanted[] = {{PrimitiveKind::kPlane, 0},
                              {PrimitiveKind::kPlane, 1},
                              {PrimitiveKind::kTriangle, 0},
                              {PrimitiveKind::kTriangle, 1},
                              {PrimitiveKind::kTriangle, 2},
                              {PrimitiveKind::kCone, 0}};
  ASSERT_EQ(p.ids.end(), std::size(wanted));
  for (std::uint32_t id = 0; id < p.ids.end(); ++id) {
    const Primitive found = p.ids.primitive(id);
    EXPECT_EQ(found.kind, wanted[id].kind) << id;
    EXPECT_EQ(found.index, wanted[id].index) << id;
    for_each_shape([&]<class Shape>() {
      EXPECT_EQ(p.ids.has(Shape::kKind, id), Shape::kKind == wanted[id].kind) << id;
    });
    if (id < p.first_finite())
      continue;
    p.visit(id, [&]<class Shape>(std::uint32_t index) {
      EXPECT_EQ(Shape::kKind, wanted[id].kind) << id;
      EXPECT_EQ(index, wanted[id].index) << id;
    });
  }
  EXPECT_FALSE(p.ids.has(PrimitiveKind::kCone, kNoPrimitive));
}

}  // namespace
}  // namespace grelha::test
