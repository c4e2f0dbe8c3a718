// Blocks of triangles and their boxes, sizes of grids, and which grids a scene gets. A part of
// grid_test.
#include "kernel/grid/grid.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <set>

#include "kernel/grid/grid_steps.hpp"
#include "tests/support/grid_cases.hpp"

namespace grelha::test {
namespace {

// ---- blocks ----

/// A sheet of n x n small triangles across the cell of a grid of one, in an order drawn by lot.
Scene shuffled_sheet(int n) {
  Random random(7);
  std::vector<int> at(static_cast<std::size_t>(n * n));
  std::iota(at.begin(), at.end(), 0);
  for (std::size_t i = at.size(); i > 1; --i)
    std::swap(
        at[i - 1],
        at[std::min(i - 1, static_cast<std::size_t>(random.unit() * static_cast<double>(i)))]);
  Scene s = empty_scene();
  const float step = 1.f / static_cast<float>(n);
  for (const int k : at) {
    const float x = static_cast<float>(k % n) * step, y = static_cast<float>(k / n) * step;
    add_triangle(s, {x, y, .5f}, {x + step, y, .5f}, {x, y + step, .5f});
  }
  return s;
}

TEST(BlockOrder, GivesEachTriangleAPlaceOfItsOwn) {
  // up to 400: few are ranked in another way than many
  for (const int n : {1, 2, 3, 5, 11, 12, 20}) {
    for (const bool heaped : {false, true}) {
      Scene scene = shuffled_sheet(n);
      Triangles& t = scene.geometry.triangles;
      if (heaped)
        for (auto* const v : {&t.x, &t.y, &t.z})
          std::fill(
              v->begin(), v->end(), n % 2 == 0 ? .5f : std::numeric_limits<float>::quiet_NaN());
      const Primitives p(scene.geometry);
      std::vector<std::uint32_t> ids(t.size()), places;
      std::iota(ids.begin(), ids.end(), p.ids.begin(PrimitiveKind::kTriangle));
      Grid one;
      for (double& c : one.cell)
        c = 1;
      BlockOrder order;
      for (const std::uint32_t place : order.places(p, ids, one, 0))
        places.push_back(place);
      std::sort(places.begin(), places.end());
      for (std::uint32_t i = 0; i < ids.size(); ++i)
        ASSERT_EQ(places[i], i) << n;
    }
  }
}

TEST(BlockOrder, PutsNeighboursInOneBlock) {
  for (const int n : {8, 20}) {
    const Scene scene = shuffled_sheet(n);
    const Primitives p(scene.geometry);
    std::vector<std::uint32_t> ids(scene.geometry.triangles.size());
    std::iota(ids.begin(), ids.end(), p.ids.begin(PrimitiveKind::kTriangle));
    Grid one;
    for (double& c : one.cell)
      c = 1;
    BlockOrder order;
    const auto places = order.places(p, ids, one, 0);
    std::vector<Box> blocks((ids.size() + kBlock - 1) / kBlock);
    for (std::size_t i = 0; i < ids.size(); ++i)
      blocks[places[i] / kBlock].add(p.box(ids[i]));
    double area = 0;
    for (const Box& b : blocks)
      area += (b.hi[0] - b.lo[0]) * (b.hi[1] - b.lo[1]);
    // The boxes of blocks cover the sheet 1.0 to 1.4 times when blocks are whole pieces of it, 20
    // times or more when drawn by lot.
    EXPECT_LT(area, 1.5) << n;
  }
}

/// By what a walk can be off, 32 u of how far away rays may start beside its way and along it
/// (docs/proofs.md); rays start further than the grid is wide.
TEST(Pads, HoldWhatRoundingTakes) {
  constexpr double kLeast = 202 * 0x1p-24;
  for (const Case& c : cases()) {
    const World world(c.scene, {});
    for (const auto& built : world.impl().grids) {
      const Grid& g = built->grid;
      EXPECT_GE(g.pad, kLeast * g.near_distance) << c.name;
      for (int a = 0; a < 3; ++a) {
        EXPECT_GE(g.near_distance, .99 * g.cell[a] * g.cells[static_cast<std::size_t>(a)])
            << c.name;
        EXPECT_GE(g.cell[a], 1.99 * g.pad) << c.name;
      }
    }
  }
}

TEST(BlockBoxes, HoldWhatLiesInTheirCell) {
  std::size_t points = 0;
  for (const Case& c : cases()) {
    const World world(c.scene, {.density = 1});
    const World::Impl& w = world.impl();
    Random random(13);
    for (const auto& built : w.grids) {
      const Grid& g = built->grid;
      const ListStore<Triangle>& s = g.store.of<Triangle>();
      if (s.first.empty())
        continue;
      const double pad = g.pad;
      for (std::size_t cell = 0; cell + 1 < s.first.size(); ++cell) {
        const std::size_t at[3] = {
            cell % g.cells[0], cell / g.cells[0] % g.cells[1], cell / g.cells[0] / g.cells[1]};
        const auto [first, end] = s.list().blocks_of(cell);
        for (std::uint32_t b = first; b < end; ++b)
          for (const std::uint32_t id : s.blocks[b].id) {
            if (id == kNoPrimitive)
              continue;
            for (const Point& q : surface_points(c.scene, w.primitives, id, random, 4)) {
              bool inside = true, boxed = true;
              for (std::size_t a = 0; a < 3; ++a) {
                inside &= q.x[a] >= g.lo[a] + double(at[a]) * g.cell[a] &&
                          q.x[a] <= g.lo[a] + double(at[a] + 1) * g.cell[a];
                // A quarter of pad, less the rounding of boxes to floats.
                const std::uint32_t place = s.first[cell] + (b - first);
                const auto& side = s.boxes[place / kBlock].side;
                boxed &= q.x[a] - .24 * pad >= side[a][place % kBlock] &&
                         q.x[a] + .24 * pad <= side[3 + a][place % kBlock];
              }
              if (!inside)
                continue;
              ASSERT_TRUE(boxed) << c.name << ", cell " << cell << ", primitive " << id;
              ++points;
            }
          }
      }
    }
  }
  EXPECT_GT(points, 5000u);
}

/// Of each place whether it has a block; that block must be the one its cell says.
std::vector<bool> places_taken(const ListStore<Triangle>& s) {
  std::vector<bool> taken(s.boxes.size() * kBlock);
  for (std::size_t cell = 0; cell + 1 < s.first.size(); ++cell) {
    const auto [first, end] = s.list().blocks_of(cell);
    for (std::uint32_t b = first; b < end; ++b) {
      const std::uint32_t place = s.first[cell] + (b - first);
      EXPECT_EQ(s.list().block_at(place), b);
      EXPECT_FALSE(taken[place]);
      taken[place] = true;
    }
  }
  return taken;
}

TEST(BlockBoxes, StandInNoMoreRowsThanTheyFill) {
  constexpr float kNever = std::numeric_limits<float>::infinity();
  std::size_t begun = 0, gaps = 0;  // cells that begin within a row; places without a block
  for (const Case& c : cases()) {
    const World world(c.scene, {.density = 1});
    for (const auto& built : world.impl().grids) {
      const Grid& g = built->grid;
      const ListStore<Triangle>& s = g.store.of<Triangle>();
      for (std::size_t cell = 0; cell + 1 < s.first.size(); ++cell) {
        const auto [first, end] = s.list().blocks_of(cell);
        const std::uint32_t place = s.first[cell];
        if (first == end)
          continue;
        EXPECT_EQ((place + (end - first) - 1) / kBlock - place / kBlock, (end - first - 1) / kBlock)
            << c.name << ", cell " << cell;
        begun += place % kBlock != 0;
      }
      const std::vector<bool> taken = places_taken(s);
      for (std::size_t place = 0; place < taken.size(); ++place)
        for (std::size_t a = 0; a < 3 && !taken[place]; ++a) {
          EXPECT_EQ(s.boxes[place / kBlock].side[a][place % kBlock], kNever) << c.name;
          EXPECT_EQ(s.boxes[place / kBlock].side[3 + a][place % kBlock], -kNever) << c.name;
          ++gaps;
        }
    }
  }
  EXPECT_GT(begun, 300u);
  EXPECT_GT(gaps, 300u);
}

// ---- sizes and choices ----

TEST(GridSize, FollowsTheFormula) {
  Scene s = empty_scene();
  for (int z = 0; z < 10; ++z)
    for (int y = 0; y < 10; ++y)
      for (int x = 0; x < 10; ++x)
        s.geometry.spheres.add({float(x), float(y), float(z)}, .5f, 0);
  for (const float density : {1.f, 2.f, 3.f}) {
    const auto grids = World(s, {.density = density}).grids();
    ASSERT_EQ(grids.size(), 1u);
    for (const std::uint32_t n : grids[0].cells)
      EXPECT_EQ(n, static_cast<std::uint32_t>(density * 10) + 1) << density;
  }
}

TEST(GridSize, StaysWithinItsBounds) {
  Scene s = empty_scene();
  for (int i = 0; i < 2000; ++i)
    add_triangle(s, {float(i), 0, 0}, {float(i), 1e-3f, 0}, {float(i), 0, 1e-3f});
  for (const float density : {.01f, 1.f, 100.f})
    for (const GridStats& g : World(s, {.density = density}).grids())
      for (const std::uint32_t n : g.cells)
        EXPECT_TRUE(n >= 1 && n <= 1024) << n;
}

/// A ball with half a million small ones around it: wherever it stands among them, so also where it
/// is one of the few that say how many references there will be.
TEST(GridSize, OneLargePrimitiveAmongManyLeavesCellsSmall) {
  constexpr std::size_t kSmall = 500'000, kStride = (kSmall + 1) / 128;
  std::set<std::uint32_t> cells;
  for (const std::size_t place : {std::size_t{0}, kStride / 2, 64 * kStride + kStride / 2}) {
    Random random(3);
    Scene s = empty_scene();
    for (std::size_t i = 0; i < kSmall; ++i) {
      if (i == place)
        s.geometry.spheres.add({.5f, .5f, .5f}, .2f, 0);
      const auto x = static_cast<float>(random.unit()), y = static_cast<float>(random.unit());
      s.geometry.spheres.add({x, y, static_cast<float>(random.unit())}, 1e-3f, 0);
    }
    const World world(s, {});
    ASSERT_EQ(world.grids().size(), 1u);
    cells.insert(world.grids()[0].cells[0]);
    EXPECT_GE(world.grids()[0].cells[0], 50u) << place;
  }
  EXPECT_EQ(cells.size(), 1u);
}

/// Spikes of a star: each crosses half of the grid, whatever its cells. A few, picked evenly,
/// say how many references there will be; all are alike but for their direction, which changes the
/// cells on their way by sqrt 2.
TEST(GridSize, SliversDoNotFillMemory) {
  Scene s = empty_scene();
  constexpr int kSpikes = 200000;
  for (int i = 0; i < kSpikes; ++i) {
    const double a = 2 * 3.14159265358979 * i / kSpikes;
    const auto x = static_cast<float>(std::cos(a)), y = static_cast<float>(std::sin(a));
    add_triangle(s, {x, y, 0}, {2 * x, 2 * y, 0}, {x, y, 1e-5f});
  }
  const World world(s, {});
  ASSERT_EQ(world.grids().size(), 1u);
  EXPECT_LE(static_cast<double>(world.grids()[0].references), (1 << 22) * std::sqrt(2.));
  EXPECT_GE(world.grids()[0].references, kSpikes * 4u) << "and no coarser than need be";
}

/// Cells as wide as high would hold a hundred sheets each.
TEST(GridSize, StackedSheetsHaveFlatCells) {
  constexpr int kSheets = 2000;
  const Scene scene = stacked_sheets(kSheets);
  const World world(scene, {});
  ASSERT_EQ(world.grids().size(), 1u);
  const GridStats g = world.grids()[0];
  EXPECT_GE(g.cells[2], 10 * std::max(g.cells[0], g.cells[1]));
  EXPECT_LE(g.references, 16 * g.occupied);
}

/// Nor would rays that go down together, a sheet each, see few in slices of few cells.
TEST(GridSize, RaysTestFewOfStackedSheets) {
  constexpr int kSheets = 2000, kRays = 1024;
  const Scene scene = stacked_sheets(kSheets);
  const World world(scene, {});
  Random random(3);
  std::vector<Ray> rays(kRays);
  for (Ray& r : rays)
    r = {at({.5f, .5f, .5f}, .4, random.direction()), at({0, 0, -1}, .5, random.direction())};
  std::vector<Hit> hits(kRays);
  TraceCounts counts;
  closest(world, rays, hits, {}, &counts);
  EXPECT_LE(counts.tests.triangle, 32u * kRays);
}

/// Where no primitive reaches far, the cells are those that the density asks for.
TEST(GridSize, CellsOfSmallTrianglesAreCubes) {
  Scene s = empty_scene();
  Random random(3);
  constexpr int kTriangles = 5000;
  for (int i = 0; i < kTriangles; ++i) {
    const Float3 p = random.point(1);
    add_triangle(s, p, at(p, .05, random.direction()), at(p, .05, random.direction()));
  }
  const World world(s, {});
  ASSERT_EQ(world.grids().size(), 1u);
  const GridStats g = world.grids()[0];
  for (const std::uint32_t n : g.cells)
    EXPECT_NEAR(n, .7 * std::cbrt(kTriangles) + .5, 1);
}

TEST(GridSize, AnOutlierDoesNotPutEverythingEverywhere) {
  // The outlier's extent sets the pad; at one part in 16,777,216 * 128 of it a whole scene lies
  // within pad of itself.
  Scene s = empty_scene();
  for (int i = 0; i < 2000; ++i) {
    const auto x = static_cast<float>(i % 50), y = static_cast<float>(i / 50);
    add_triangle(s, {x, y, 0}, {x + 1, y, 0}, {x, y + 1, 1});
  }
  s.geometry.triangles.z[0] = 4294967296.f;
  const World world(s, {});
  // Cells are at least 2 pad wide. A padded box, at most 3 pad + its own size across, touches at
  // most 3 cells on an axis.
  for (const GridStats& g : world.grids())
    EXPECT_LE(g.references, 27u * 2000u);
  // For rays that start near, the rest have cells like theirs alone, but for a pad of a 64th on
  // each side.
  s.geometry.triangles.z[0] = 0;
  const World alone(s, {});
  ASSERT_EQ(world.grids().size(), 1u);
  ASSERT_EQ(alone.grids().size(), 1u);
  EXPECT_LE(static_cast<double>(world.grids()[0].references),
            std::pow(1 + 2. / 64, 3) * static_cast<double>(alone.grids()[0].references));
}

/// Rays from all over a vast scene may ask for a pad that is large beside the cells; its grid is as
/// fine as if there were nothing else.
TEST(GridChoice, WhatIsSmallInAVastSceneHasOneGridAsIfAlone) {
  const Scene vast = mesh_in_a_vast_scene();
  const World world(vast, {});
  ASSERT_EQ(world.impl().grids.size(), 1u);
  const Grid& g = world.impl().grids[0]->grid;
  EXPECT_LE(g.pad, g.cell[0] / 32);
  Scene alone = empty_scene();
  add_object(alone, ball_mesh(24, 12, .2));
  EXPECT_EQ(g.cells, World(alone, {}).impl().grids[0]->grid.cells);
  for (const float half : {100.f, 1e3f, 1e5f}) {
    const Scene crowd = crowd_on_a_plain(3, 300, half);
    EXPECT_EQ(World(crowd, {}).grids().size(), 1u) << half;
  }
}

TEST(GridChoice, HugePrimitivesStandOutside) {
  const Scene scene = stadium(3, 300);
  const World world(scene, {});
  ASSERT_EQ(world.impl().grids.size(), 1u);
  const auto outside = ids_of(world.impl().outside, 0);
  // two triangles behind the cluster
  const std::uint32_t ground = world.impl().primitives.ids.begin(PrimitiveKind::kTriangle) + 300;
  EXPECT_TRUE(std::binary_search(outside.begin(), outside.end(), ground));
  EXPECT_TRUE(std::binary_search(outside.begin(), outside.end(), ground + 1));
}

TEST(GridChoice, LargeObjectsGetTheirOwnGrid) {
  Scene scene = ball_mesh(32, 16);
  const auto n = static_cast<std::uint32_t>(scene.geometry.triangles.size());
  scene.geometry.objects.push_back({0, n});
  Random random(1);
  add_triangles(scene, random, 100, 30, .1, 1);
  EXPECT_EQ(World(scene, {}).grids().size(), 2u);
  EXPECT_EQ(World(scene, {.grid = false}).grids().size(), 0u);
  const World world(scene, {});
  RayList rays = rays_about(random, {}, 20, kManyRays);
  expect_truth(*find_variant("best"), world, rays, truth_of(scene, rays), "two grids");
}

TEST(WorldCheck, RefusesWhatWouldReadOutOfBounds) {
  Scene s = random_mixture(1, 30);
  s.geometry.spheres.material[0] = 9;
  EXPECT_THROW(World(s, {}), std::invalid_argument);
  s = random_mixture(1, 30);
  s.geometry.triangles.b[3] = 1u << 20;
  EXPECT_THROW(World(s, {}), std::invalid_argument);
  s = random_mixture(1, 30);
  s.geometry.objects = {{5, 3}, {7, 2}};
  EXPECT_THROW(World(s, {}), std::invalid_argument);
  s.geometry.objects = {{5, 3000}};
  EXPECT_THROW(World(s, {}), std::invalid_argument);
}

TEST(WorldCheck, AnEmptySceneIsOne) {
  const Scene scene = empty_scene();
  const World world(scene, {});
  Random random(1);
  const RayList rays = rays_about(random, {}, 1, 100);
  for (const Way& way : every_way())
    EXPECT_EQ(hits_of(trace(*find_variant("best"), world, rays, way.settings, Query::kClosest)), 0u)
        << way.name;
}

}  // namespace
}  // namespace grelha::test
