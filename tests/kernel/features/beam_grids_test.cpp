// That what a beam knows does not depend on the grids it walks.
#include "tests/support/beams.hpp"
#include "tests/support/rays.hpp"

namespace grelha::test {
namespace {

class BeamGrids : public EveryVariant {
 protected:
  Tile look(const Scene& s) const { return doubt(s, variant()); }
};
GRELHA_FOR_EVERY_ISA(BeamGrids);

/// A wall that mirrors, with so many spheres and triangles about it.
Scene crowded_wall(std::uint64_t seed, int count) {
  Scene s = wall();
  Random random(seed);
  add_spheres(s, random, count, 6, .01, .4);
  add_triangles(s, random, count, 6, .1, 2);
  s.materials[0].mirror = {.6f, .6f, .6f};
  return s;
}

TEST_P(BeamGrids, IsTheSameForEveryGridAndInstructionSet) {
  const Scene s = crowded_wall(7, 60);
  const Tile want = doubt(s, *variants().front(), {.grid = false});
  for (const float density : {.5f, 1.f, 4.f})
    EXPECT_EQ(doubt(s, variant(), {.density = density}), want) << density;
  int plain = 0;
  for (const float d : want)
    plain += d == 0;
  EXPECT_GT(plain, 0);
  EXPECT_LT(plain, 64);
}

/// Each primitive `times` more often, of another material.
Scene with_copies(const Scene& of, int times) {
  Scene s = of;
  const std::uint32_t other = 1;
  s.materials.resize(2);
  for (int k = 0; k < times; ++k) {
    const Spheres& balls = of.geometry.spheres;
    for (std::size_t i = 0; i < balls.size(); ++i)
      s.geometry.spheres.add({balls.x[i], balls.y[i], balls.z[i]}, balls.radius[i], other);
    const Triangles& t = of.geometry.triangles;
    for (std::size_t i = 0; i < t.size(); ++i)
      add_triangle(s, vertex(of, t.a[i]), vertex(of, t.b[i]), vertex(of, t.c[i]), other);
  }
  return s;
}

/// Grids leave out copies where cells are crowded. The first of a kind is what is seen.
TEST_P(BeamGrids, IsTheSameWithCopiesAsWithout) {
  const Scene s = crowded_wall(8, 30);
  const Tile want = look(s);
  for (const int times : {1, 60}) {
    const Scene copied = with_copies(s, times);
    EXPECT_EQ(look(copied), want) << times;
    EXPECT_EQ(doubt(copied, variant(), {.grid = false}), want) << times;
  }
}

/// A ray to the middle of a copy meets a speck before it, and would take it for as large.
TEST_P(BeamGrids, LooksForNoCopyOfWhatItsCornersMet) {
  Scene s = empty_scene();
  add_triangle(s, {-50, -50, 0}, {50, -50, 0}, {0, 90, 0});
  s.geometry.spheres.add({-1.5f, 2.5f, 0}, .1f, 0);  // in the middle of pixel (2, 1)
  constexpr int kPixel = 8 + 2;
  for (const int times : {0, 1}) {
    const PixelDoubts found = doubts(with_copies(s, times), variant());
    EXPECT_EQ(found.boxed[kPixel], 1) << times;
    EXPECT_EQ(found.inside[kPixel], 0) << times;
  }
}

TEST_P(BeamGrids, IsTheSameWhereGridsServeNearRaysOrFarOnes) {
  Scene s = wall();
  Random random(7);
  add_spheres(s, random, 60, 6, .01, .4);
  add_triangle(s, {-1e6f, -1e6f, -9}, {1e6f, -1e6f, -9}, {0, 1e6f, -9});  // behind the wall
  const Tile want = doubt(s, *variants().front(), {.grid = false});
  bool near[2] = {};
  for (const float density : {1.f, 40.f}) {
    const World world(s, {.density = density});
    const GridView& g = world.impl().grid_views.front();
    ASSERT_EQ(g.serves, Serves::kNear);
    near[density > 1] = over_units().eye.z <= g.near_hi[2];
    EXPECT_EQ(doubt(s, variant(), {.density = density}), want) << density;
  }
  EXPECT_TRUE(near[0]);
  EXPECT_FALSE(near[1]);
}

/// A mirror sends a beam forty times as wide as a mesh on to it, and a wall stands behind that. In
/// the direction of x two edges are beyond the mesh's grid where they begin, the others before it
/// where they end.
TEST_P(BeamGrids, FindsWhatNoEdgeOfItComesTo) {
  const Float3 on{-.8f, 0, -.6f};
  Scene s = one_plane({0, 0, 0}, {-.8f, 1, -.6f});
  s.materials[0].mirror = {1, 1, 1};
  s.materials.emplace_back();
  s.geometry.planes.add(at({0, 0, 0}, 52, on), {.8f, 0, .6f}, 1);
  s.lights.clear();
  Camera c = over_units();
  c.eye = {0, 1000, 0};
  c.up = {.8f, 0, .6f};
  c.angle_deg = 18.2;
  const Tile plain = doubt(s, variant(), {}, c);
  // a pixel sees (0, -20, 0) + 20 on + 20 beside in the mirror, and this 30 behind
  const Float3 beside{-.6f, 0, .8f};
  add_object(s, placed(ball_mesh(24, 12), .5, at(at({0, -20, 0}, 50, on), 20, beside)));
  ASSERT_FALSE(World(s, {}).impl().grid_views.empty());
  const Tile tile = doubt(s, variant(), {}, c);
  EXPECT_NE(tile, plain);
  EXPECT_EQ(tile, doubt(s, variant(), {.grid = false}, c));
}

/// A mesh so far away that rays walk its grid one by one.
TEST_P(BeamGrids, DoubtsAMeshFromAfarWhereItIs) {
  Scene s = wall();
  s.lights.clear();
  Scene ball = placed(ball_mesh(24, 12), 1e-3, {-1.3f, 2.4f, 0});  // pixel (2, 1)
  add_object(s, ball);
  add_triangle(s, {-1e6f, -1e6f, -9}, {1e6f, -1e6f, -9}, {0, 1e6f, -9});  // behind the wall
  bool afar = false;
  const World world(s, {});
  for (const GridView& g : world.impl().grid_views)
    afar |= g.serves == Serves::kNearAndAfar && over_units().eye.z > g.near_hi[2];
  EXPECT_TRUE(afar);
  const Tile tile = look(s);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      EXPECT_EQ(at(tile, x, y) > 0, x == 2 && y == 1) << x << ' ' << y;
  EXPECT_EQ(tile, doubt(s, variant(), {.grid = false}));
}

}  // namespace
}  // namespace grelha::test
