// What a built grid promises: sound rows, every primitive in each cell its surface touches, exact
// distances.
#include "kernel/copies.hpp"
#include "kernel/grid.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <set>

#include "kernel/block_order.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

// ---- distances
// ------------------------------------------------------------------------------------------

int naive_distance(const std::vector<std::uint8_t>& occupied,
                   const std::array<std::uint32_t, 3>& n,
                   std::uint32_t at) {
  const auto place = [&](std::uint32_t c) {
    return std::array<int, 3>{int(c % n[0]), int(c / n[0] % n[1]), int(c / n[0] / n[1])};
  };
  const auto p = place(at);
  int least = 255;
  for (std::uint32_t c = 0; c < occupied.size(); ++c) {
    if (!occupied[c])
      continue;
    const auto q = place(c);
    least = std::min(
        least, std::max({std::abs(p[0] - q[0]), std::abs(p[1] - q[1]), std::abs(p[2] - q[2])}));
  }
  return least;
}

TEST(Distance, IsThatOfTheNearestOccupiedCell) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const std::array<std::uint32_t, 3> n{
        1 + random.below(14), 1 + random.below(14), 1 + random.below(14)};
    std::vector<std::uint8_t> occupied(std::size_t{n[0]} * n[1] * n[2]);
    const double share = random.log_in(1e-3, .5);
    for (auto& o : occupied)
      o = random.chance(share);
    const auto distance = chebyshev_distance(occupied, n);
    for (std::uint32_t c = 0; c < occupied.size(); ++c)
      ASSERT_EQ(distance[c], naive_distance(occupied, n, c)) << "seed " << seed << ", cell " << c;
  }
}

TEST(Distance, StopsAt255) {
  const std::array<std::uint32_t, 3> n{600, 2, 1};
  std::vector<std::uint8_t> occupied(1200);
  occupied[0] = 1;
  const auto distance = chebyshev_distance(occupied, n);
  for (std::uint32_t x = 0; x < 600; ++x)
    EXPECT_EQ(distance[x], std::min(x, 255u)) << x;
  // nothing anywhere
  EXPECT_EQ(chebyshev_distance(std::vector<std::uint8_t>(8), {2, 2, 2}),
            std::vector<std::uint8_t>(8, 255));
}

// ---- rows
// ------------------------------------------------------------------------------------------

/// Ids in one cell, in the order they stand there; those of triangles, which stand as their blocks
/// want it, ascending.
std::vector<std::uint32_t> ids_of(const CellStore& s, std::size_t cell) {
  std::vector<std::uint32_t> out;
  if (!s.sphere_first.empty())
    for (std::uint32_t i = s.sphere_first[cell]; i < s.sphere_first[cell + 1]; ++i)
      out.push_back(s.sphere_id[i]);
  const auto spheres = static_cast<std::ptrdiff_t>(out.size());
  if (!s.triangle_first.empty())
    for (std::uint32_t b = s.triangle_first[cell]; b < s.triangle_first[cell + 1]; ++b)
      for (const std::uint32_t id : s.triangles[b].id)
        if (id != kNoPrimitive)
          out.push_back(id);
  std::sort(out.begin() + spheres, out.end());
  if (!s.cone_first.empty())
    for (std::uint32_t i = s.cone_first[cell]; i < s.cone_first[cell + 1]; ++i)
      out.push_back(s.cone_id[i]);
  return out;
}

void expect_sound_rows(const CellStore& s, std::size_t cells) {
  for (const auto* first : {&s.sphere_first, &s.triangle_first, &s.cone_first}) {
    if (first->empty())
      continue;
    ASSERT_EQ(first->size(), cells + 1);
    EXPECT_EQ(first->front(), 0u);
    EXPECT_TRUE(std::is_sorted(first->begin(), first->end()));
  }
  if (!s.triangle_first.empty()) {
    EXPECT_EQ(s.triangle_first.back(), s.triangles.size());
  }
  if (!s.sphere_first.empty()) {
    // a whole block can be read from any place
    EXPECT_EQ(s.sphere_first.back() + kBlock, s.sphere_id.size());
    for (const auto& v : s.spheres)
      EXPECT_EQ(v.size(), s.sphere_id.size());
    for (std::size_t i = s.sphere_first.back(); i < s.sphere_id.size(); ++i)
      EXPECT_TRUE(std::isnan(s.spheres[3][i]));
  }
  if (!s.cone_first.empty()) {
    EXPECT_EQ(s.cone_first.back() + kBlock, s.cone_id.size());
    for (const auto& v : s.cones)
      EXPECT_EQ(v.size(), s.cone_id.size());
  }
  for (const TriangleBlock& b : s.triangles)
    for (int i = 0; i < kBlock; ++i) {
      EXPECT_EQ(b.id[i] == kNoPrimitive, std::isnan(b.a[0][i]));
      if (i > 0 && b.id[i - 1] == kNoPrimitive) {
        EXPECT_EQ(b.id[i], kNoPrimitive);  // gaps at the end alone
      }
    }
  std::uint64_t references = 0;
  for (std::size_t c = 0; c < cells; ++c) {
    const auto ids = ids_of(s, c);
    references += ids.size();
    // ascending, none twice
    EXPECT_TRUE(std::is_sorted(ids.begin(), ids.end(), std::less_equal<>())) << "cell " << c;
  }
  EXPECT_EQ(references, s.references);
}

template <class T>
void expect_same_bytes(const T& a, const T& b) {
  ASSERT_EQ(a.size(), b.size());
  if (!a.empty()) {
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]), 0);
  }
}

void expect_same_store(const CellStore& a, const CellStore& b) {
  for (const auto list : {&CellStore::triangle_first,
                          &CellStore::sphere_first,
                          &CellStore::cone_first,
                          &CellStore::sphere_id,
                          &CellStore::cone_id})
    expect_same_bytes(a.*list, b.*list);
  expect_same_bytes(a.triangles, b.triangles);
  expect_same_bytes(a.boxes, b.boxes);
  for (std::size_t k = 0; k < a.spheres.size(); ++k)
    expect_same_bytes(a.spheres[k], b.spheres[k]);
  for (std::size_t k = 0; k < a.cones.size(); ++k)
    expect_same_bytes(a.cones[k], b.cones[k]);
  EXPECT_EQ(a.references, b.references);
}

struct Point {
  double x[3];
};
Point mixed(const Float3& p, double s, const Float3& d, double t = 0, const Float3& e = {}) {
  return {{p.x + s * d.x + t * e.x, p.y + s * d.y + t * e.y, p.z + s * d.z + t * e.z}};
}
double dot(const Point& a, const Point& b) {
  return a.x[0] * b.x[0] + a.x[1] * b.x[1] + a.x[2] * b.x[2];
}

/// Points on the surface of a primitive, corners and edges among them, in double: far from 0 a
/// float would lie beside it.
std::vector<Point> surface_points(
    const Scene& s, const Primitives& p, std::uint32_t id, Random& random, int count) {
  std::vector<Point> out;
  const Geometry& g = s.geometry;
  for (int i = 0; i < count; ++i) {
    if (id < p.triangle_base) {
      const std::uint32_t k = id - p.sphere_base;
      Float3 d = random.direction();
      if (i < 6)
        d = {}, component(d, i % 3u) = i < 3 ? 1.f : -1.f;
      const Point unit = mixed({}, 1, d);
      out.push_back(mixed({g.spheres.x[k], g.spheres.y[k], g.spheres.z[k]},
                          std::abs(double{g.spheres.radius[k]}) / std::sqrt(dot(unit, unit)),
                          d));
    } else if (id < p.cone_base) {
      const std::uint32_t k = id - p.triangle_base;
      const Float3 a = vertex(s, g.triangles.a[k]), b = vertex(s, g.triangles.b[k]),
                   c = vertex(s, g.triangles.c[k]);
      const double u = i < 8 ? i % 2 : random.unit(),
                   v = (1 - u) * (i < 8 ? i / 2 % 2 : random.unit());
      Point q;
      for (std::uint32_t k2 = 0; k2 < 3; ++k2) {
        Float3 corner[3] = {a, b, c};
        const double x[3] = {
            component(corner[0], k2), component(corner[1], k2), component(corner[2], k2)};
        q.x[k2] = x[0] + u * (x[1] - x[0]) + v * (x[2] - x[0]);
      }
      out.push_back(q);
    } else {
      const std::uint32_t k = id - p.cone_base;
      const Cones& c = g.cones;
      const double base[3] = {c.base_x[k], c.base_y[k], c.base_z[k]};
      const Point axis{{c.apex_x[k] - base[0], c.apex_y[k] - base[1], c.apex_z[k] - base[2]}};
      const double h = i < 8 ? i % 2 : random.unit();
      const double r = std::abs(c.base_radius[k]) * (1 - h) + std::abs(c.apex_radius[k]) * h;
      for (;;) {
        const Point d = mixed({}, 1, random.direction());
        const double along = dot(d, axis) / dot(axis, axis);
        Point across;
        for (int a = 0; a < 3; ++a)
          across.x[a] = d.x[a] - along * axis.x[a];
        const double l = std::sqrt(dot(across, across));
        if (l < .1)
          continue;
        Point q;
        for (int a = 0; a < 3; ++a)
          q.x[a] = base[a] + h * axis.x[a] + r / l * across.x[a];
        out.push_back(q);
        break;
      }
    }
  }
  return out;
}

struct Case {
  const char* name;
  Scene scene;
};

std::vector<Case> cases() {
  const Float3 far{148376, 1234, -223423};
  return {{"spheres", random_spheres(3, 300)},
          {"triangles", random_triangles(3, 300)},
          {"cones", random_cones(3, 200)},
          {"mixture", random_mixture(3, 300)},
          {"flat", flat_sheet(3, 200)},
          {"needles", needles(3, 90)},
          {"heap", heap(3, 20)},
          {"stadium", stadium(3, 300)},
          {"wide plain", crowd_on_a_wide_plain(3, 300)},
          {"lattice", lattice_patch(9)},
          {"towns", towns_in_a_desert(3, 3000)},
          {"tiny", placed(random_mixture(3, 300), 1e-6, {})},
          {"far", placed(random_mixture(3, 300), 2, far)}};
}

TEST(GridRows, AreTheSameForAnyNumberOfThreads) {
  std::vector<Case> all = cases();
  // several chunks of primitives, several buckets of cells
  all.push_back({"many", random_mixture(5, 20000)});
  for (const Case& c : all) {
    SCOPED_TRACE(c.name);
    const World one(c.scene, {.threads = 1});
    for (const int threads : {2, 3, 8}) {
      const World many(c.scene, {.threads = threads});
      expect_same_store(one.impl().outside, many.impl().outside);
      ASSERT_EQ(one.impl().grids.size(), many.impl().grids.size());
      for (std::size_t i = 0; i < one.impl().grids.size(); ++i) {
        const Grid &a = one.impl().grids[i], &b = many.impl().grids[i];
        EXPECT_EQ(a.cells, b.cells);
        EXPECT_EQ(a.distance, b.distance);
        EXPECT_EQ(a.occupied, b.occupied);
        expect_same_store(a.store, b.store);
      }
    }
  }
}

TEST(GridRows, HoldWhatTheyPromise) {
  for (const Case& c : cases())
    for (const float density : {.5f, 1.f, 2.f, 4.f}) {
      SCOPED_TRACE(c.name);
      const World world(c.scene, {.density = density});
      const World::Impl& w = world.impl();
      // what rays that start near, and far away, may meet
      std::vector<int> near(w.primitives.end), far(w.primitives.end);
      expect_sound_rows(w.outside, 1);
      for (const std::uint32_t id : ids_of(w.outside, 0)) {
        ++near[id];
        ++far[id];
      }
      for (const Grid& g : w.grids) {
        const std::size_t cells = std::size_t{g.cells[0]} * g.cells[1] * g.cells[2];
        expect_sound_rows(g.store, cells);
        std::vector<std::uint8_t> occupied(cells);
        std::set<std::uint32_t> members;
        for (std::size_t i = 0; i < cells; ++i) {
          const auto ids = ids_of(g.store, i);
          occupied[i] = !ids.empty();
          members.insert(ids.begin(), ids.end());
        }
        for (const std::uint32_t id : members) {
          near[id] += g.serves != Serves::kFar;
          far[id] += g.serves != Serves::kNear;
        }
        EXPECT_EQ(g.occupied, std::accumulate(occupied.begin(), occupied.end(), std::uint64_t{0}));
        const auto distance = chebyshev_distance(occupied, g.cells);
        ASSERT_GE(g.distance.size(), cells + 3) << "four bytes are read at once";
        EXPECT_TRUE(std::equal(distance.begin(), distance.end(), g.distance.begin()));
      }
      std::vector<std::uint32_t> all(w.primitives.end - w.primitives.sphere_base);
      std::iota(all.begin(), all.end(), w.primitives.sphere_base);
      const auto copies = copies_among(w.primitives, all);
      // far towns have some: floats lie far apart there
      const std::set<std::uint32_t> may_lack(copies.begin(), copies.end());
      for (const std::uint32_t id : all) {
        const bool held = near[id] == 1 && far[id] == 1,
                   left_out = near[id] <= 1 && far[id] <= 1 && may_lack.contains(id);
        EXPECT_TRUE(held || left_out) << "primitive " << id;
      }
    }
}

TEST(GridRows, HoldAPrimitiveInEachCellItsSurfaceTouches) {
  std::size_t points = 0;
  for (const Case& c : cases())
    for (const float density : {.5f, 1.f, 4.f}) {
      const World world(c.scene, {.density = density});
      const World::Impl& w = world.impl();
      Random random(11);
      for (const Grid& g : w.grids) {
        std::vector<std::vector<std::uint32_t>> rows(std::size_t{g.cells[0]} * g.cells[1] *
                                                     g.cells[2]);
        std::set<std::uint32_t> members;
        for (std::size_t i = 0; i < rows.size(); ++i) {
          rows[i] = ids_of(g.store, i);
          members.insert(rows[i].begin(), rows[i].end());
        }
        for (const std::uint32_t id : members)
          for (const Point& p : surface_points(c.scene, w.primitives, id, random, 60)) {
            std::size_t at[3];
            for (std::size_t a = 0; a < 3; ++a)
              at[a] = static_cast<std::size_t>(
                  cell_of(p.x[a], g.lo[a], 1 / g.cell[a], static_cast<int>(g.cells[a])));
            const auto& row = rows[at[0] + g.cells[0] * (at[1] + std::size_t{g.cells[1]} * at[2])];
            ASSERT_TRUE(std::binary_search(row.begin(), row.end(), id))
                << c.name << ", density " << density << ", primitive " << id;
            ++points;
          }
      }
    }
  EXPECT_GT(points, 300000u);
}

// ---- blocks
// ------------------------------------------------------------------------------------------

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
      std::iota(ids.begin(), ids.end(), p.triangle_base);
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
    std::iota(ids.begin(), ids.end(), p.triangle_base);
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

/// By what a test and a walk can be off, 170 and 32 u of how far away rays may start
/// (docs/numerics.md).
TEST(Pads, HoldWhatRoundingTakes) {
  constexpr double kLeast = 202 * 0x1p-24;
  for (const Case& c : cases()) {
    const World world(c.scene, {});
    for (const Grid& g : world.impl().grids) {
      double reach = world.impl().view.reach;
      // near_lo to near_hi are the box and the reach on both sides
      if (g.serves == Serves::kNear) {
        double box = 0;
        reach = 1e300;
        for (int a = 0; a < 3; ++a)
          reach = std::min(reach, .5 * (double(g.near_hi[a]) - g.near_lo[a]));
        for (int a = 0; a < 3; ++a)
          box = std::max(box, double(g.near_hi[a]) - g.near_lo[a] - 2 * reach);
        reach -= .5 * box;
      }
      EXPECT_GE(g.pad, kLeast * reach) << c.name;
      for (int a = 0; a < 3; ++a)
        EXPECT_GE(g.cell[a], 1.99 * g.pad) << c.name;
    }
  }
}

TEST(BlockBoxes, HoldWhatLiesInTheirCell) {
  std::size_t points = 0;
  for (const Case& c : cases()) {
    const World world(c.scene, {.density = 1});
    const World::Impl& w = world.impl();
    Random random(13);
    for (const Grid& g : w.grids) {
      const CellStore& s = g.store;
      if (s.triangle_first.empty())
        continue;
      const double pad = g.pad;
      for (std::size_t cell = 0; cell + 1 < s.triangle_first.size(); ++cell) {
        const std::size_t at[3] = {
            cell % g.cells[0], cell / g.cells[0] % g.cells[1], cell / g.cells[0] / g.cells[1]};
        for (std::uint32_t b = s.triangle_first[cell]; b < s.triangle_first[cell + 1]; ++b)
          for (const std::uint32_t id : s.triangles[b].id) {
            if (id == kNoPrimitive)
              continue;
            for (const Point& q : surface_points(c.scene, w.primitives, id, random, 4)) {
              bool inside = true, boxed = true;
              for (std::size_t a = 0; a < 3; ++a) {
                inside &= q.x[a] >= g.lo[a] + double(at[a]) * g.cell[a] &&
                          q.x[a] <= g.lo[a] + double(at[a] + 1) * g.cell[a];
                // A quarter of pad, less the rounding of boxes to floats.
                const auto& side = s.boxes[b / kBlock].side;
                boxed &= q.x[a] - .24 * pad >= side[a][b % kBlock] &&
                         q.x[a] + .24 * pad <= side[3 + a][b % kBlock];
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

// ---- sizes and choices
// ------------------------------------------------------------------------------------------

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

/// Spikes of a star: each crosses half of the grid, whatever its cells. 128 of them, picked evenly,
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
  // Cells of at least 2 pad: a grown box, at most 3 pad + its own size across, touches at most 3 of
  // them on an axis.
  for (const GridStats& g : world.grids())
    EXPECT_LE(g.references, 27u * 2000u);
  // For rays that start near, the rest have cells like theirs alone, but for a pad of a 64th on
  // each side.
  s.geometry.triangles.z[0] = 0;
  const World alone(s, {});
  ASSERT_EQ(world.grids().size(), 2u);
  ASSERT_EQ(alone.grids().size(), 1u);
  EXPECT_LE(static_cast<double>(world.grids()[0].references),
            std::pow(1 + 2. / 64, 3) * static_cast<double>(alone.grids()[0].references));
}

TEST(GridChoice, OnlyVastScenesHaveGridsForNearAndForFarRays) {
  for (const float half : {100.f, 500.f, 1e5f}) {
    const Scene scene = crowd_on_a_plain(3, 300, half);
    const World world(scene, {});
    const auto& grids = world.impl().grids;
    if (half < 1000) {
      ASSERT_EQ(grids.size(), 1u) << half;
      EXPECT_EQ(grids[0].serves, Serves::kAll);
      continue;
    }
    ASSERT_EQ(grids.size(), 2u);
    EXPECT_EQ(grids[0].serves, Serves::kNear);
    EXPECT_EQ(grids[1].serves, Serves::kFar);
    EXPECT_GT(grids[0].cells[0], grids[1].cells[0]);
  }
}

TEST(GridChoice, HugePrimitivesStandOutside) {
  const Scene scene = stadium(3, 300);
  const World world(scene, {});
  ASSERT_EQ(world.impl().grids.size(), 1u);
  const auto outside = ids_of(world.impl().outside, 0);
  // two triangles behind the crowd
  const std::uint32_t ground = world.impl().primitives.triangle_base + 300;
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
  Rays rays = rays_about(random, {}, 20, kManyRays);
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
  const Rays rays = rays_about(random, {}, 1, 100);
  for (const Way& way : every_way())
    EXPECT_EQ(hits_of(trace(*find_variant("best"), world, rays, way.settings, Query::kClosest)), 0u)
        << way.name;
}

}  // namespace
}  // namespace grelha::test
