// Tests the guarantees of a built grid: valid rows, every primitive in each cell that its surface
// overlaps, exact distances.
#include "kernel/shapes/primitives.hpp"
#include "kernel/grid/grid.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "kernel/grid/grid_steps.hpp"
#include "kernel/grid/distance_field.hpp"
#include "tests/support/grid_cases.hpp"
#include "tests/support/same_grids.hpp"

namespace grelha::test {
namespace {

// ---- distances ----

int naive_distance(const std::vector<std::uint8_t>& occupied,
                   const std::array<std::uint32_t, 3>& n,
                   std::uint32_t at,
                   std::size_t field) {
  const auto is_before = [&](int from, int to, int axis) {
    return field == 0 || ((field - 1) >> axis & 1 ? to <= from : to >= from);
  };
  const auto place = [&](std::uint32_t c) {
    return std::array<int, 3>{int(c % n[0]), int(c / n[0] % n[1]), int(c / n[0] / n[1])};
  };
  const auto p = place(at);
  int least = 255;
  for (std::uint32_t c = 0; c < occupied.size(); ++c) {
    if (!occupied[c])
      continue;
    const auto q = place(c);
    if (!is_before(p[0], q[0], 0) || !is_before(p[1], q[1], 1) || !is_before(p[2], q[2], 2))
      continue;
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
    const auto distance = distance_transform(occupied, n, 1 + kOctants);
    for (std::size_t field = 0; field <= kOctants; ++field)
      for (std::uint32_t c = 0; c < occupied.size(); ++c)
        ASSERT_EQ(distance[field * occupied.size() + c], naive_distance(occupied, n, c, field))
            << "seed " << seed << ", cell " << c << ", field " << field;
    const auto alone = distance_transform(occupied, n, 1);
    EXPECT_TRUE(std::equal(alone.begin(), alone.end() - 3, distance.begin()));
  }
}

TEST(Distance, StopsAt255) {
  const std::array<std::uint32_t, 3> n{600, 2, 1};
  std::vector<std::uint8_t> occupied(1200);
  occupied[0] = 1;
  const auto distance = distance_transform(occupied, n, 1 + kOctants);
  constexpr std::uint32_t up = 1200, down = 2400;  // along x
  for (std::uint32_t x = 0; x < 600; ++x) {
    EXPECT_EQ(distance[x], std::min(x, 255u)) << x;
    EXPECT_EQ(distance[up + x], x == 0 ? 0 : 255) << x;
    EXPECT_EQ(distance[down + x], std::min(x, 255u)) << x;
  }
  // nothing anywhere
  const auto nothing = distance_transform(std::vector<std::uint8_t>(8), {2, 2, 2}, 1 + kOctants);
  EXPECT_TRUE(std::all_of(nothing.begin(), nothing.begin() + 72, [](int d) { return d == 255; }));
}

// ---- rows ----

void expect_sound_rows(const CellStore& s, std::size_t cells) {
  for_each_finite_shape([&]<class Shape>() {
    const auto& list = s.of<Shape>();
    if (list.first.empty())
      return;
    ASSERT_EQ(list.first.size(), cells + 1);
    EXPECT_EQ(list.first.front(), 0u);
    EXPECT_TRUE(std::is_sorted(list.first.begin(), list.first.end()));
    if constexpr (Shape::kInBlocks) {
      EXPECT_EQ(list.list().blocks_of(cells - 1).second, list.blocks.size());
    } else {
      // a whole block can be read from any place
      EXPECT_EQ(list.first.back() + kBlock, list.id.size());
      const auto expect_padded = [&](const float* row) {
        for (std::size_t i = list.first.back(); i < list.id.size(); ++i)
          EXPECT_TRUE(std::isnan(row[i]));
      };
      const auto arrays = list.list();
      Shape::for_each_field(expect_padded, arrays.fields);
    }
  });
  for (const TriangleBlock& b : s.of<Triangle>().blocks)
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

TEST(GridRows, AreTheSameForAnyNumberOfThreads) {
  std::vector<Case> all = cases();
  // several chunks of primitives, several buckets of cells
  all.push_back({"many", random_mixture(5, 20000)});
  for (const Case& c : all) {
    SCOPED_TRACE(c.name);
    const World one(c.scene, {.threads = 1});
    for (const int threads : {2, 3, 8}) {
      const World many(c.scene, {.threads = threads});
      EXPECT_TRUE(same_grids(one, many)) << threads;
    }
  }
}

TEST(GridRows, HoldWhatTheyPromise) {
  for (const Case& c : cases())
    for (const float density : {.5f, 1.f, 2.f, 4.f}) {
      SCOPED_TRACE(c.name);
      const World world(c.scene, {.density = density});
      const World::Impl& w = world.impl();
      std::vector<int> held_by(w.primitives.ids.end());
      expect_sound_rows(w.outside, 1);
      for (const std::uint32_t id : ids_of(w.outside, 0)) {
        ++held_by[id];
      }
      for (const auto& built : w.grids) {
        const Grid& g = built->grid;
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
          ++held_by[id];
        }
        EXPECT_EQ(g.occupied, std::accumulate(occupied.begin(), occupied.end(), std::uint64_t{0}));
        EXPECT_EQ(g.distance, distance_transform(occupied, g.cells, 1 + kOctants));
      }
      std::vector<std::uint32_t> all(w.primitives.finite_count());
      std::iota(all.begin(), all.end(), w.primitives.first_finite());
      const auto copies = find_duplicates(w.primitives, all);
      // far towns have some: floats lie far apart there
      std::set<std::uint32_t> may_lack;
      for (const Copy& copy : copies)
        may_lack.insert(copy.copy);
      for (const std::uint32_t id : all) {
        const bool held = held_by[id] == 1;
        const bool left_out = held_by[id] == 0 && may_lack.contains(id);
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
      for (const auto& built : w.grids) {
        const Grid& g = built->grid;
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

// ---- levels of boxes ----

bool is_within(const BlockBoxes& row, int k, const BlockBoxes& outer, int of) {
  bool within = true;
  for (int a = 0; a < 3; ++a)
    within &= row.side[a][k] > row.side[3 + a][k] ||
              (outer.side[a][of] <= row.side[a][k] && row.side[3 + a][k] <= outer.side[3 + a][of]);
  return within;
}

TEST(BoxLevels, HoldEachCellOnceAndBoundWhatIsBelow) {
  for (const Scene& scene : {ball_mesh(200, 100), random_mixture(3, 5000), stacked_sheets(400)}) {
    const World world(scene, {});
    for (const auto& built : world.impl().grids) {
      const Grid& g = built->grid;
      const BoxLevels& levels = g.levels;
      std::set<std::uint32_t> cells(levels.cells.begin(), levels.cells.end());
      EXPECT_EQ(cells.size(), levels.cells.size());
      EXPECT_EQ(cells.size(), g.occupied);
      for (const std::uint32_t cell : cells)
        EXPECT_EQ(g.distance[cell], 0);
      ASSERT_FALSE(levels.first.empty());
      EXPECT_EQ(levels.rows.size(), levels.first.back() + 1u) << "the last level is one row";
      for (std::size_t level = 1; level < levels.first.size(); ++level)
        for (std::uint32_t row = levels.first[level - 1]; row < levels.first[level]; ++row)
          for (int k = 0; k < kBlock; ++k) {
            const std::uint32_t above = row - levels.first[level - 1];
            EXPECT_TRUE(is_within(levels.rows[row],
                                  k,
                                  levels.rows[levels.first[level] + above / kBlock],
                                  static_cast<int>(above % kBlock)));
          }
      EXPECT_EQ(levels.bytes(), box_level_bytes(cells.size()));
    }
  }
}

}  // namespace
}  // namespace grelha::test
