#include "kernel/grid/grid.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include "kernel/grid/grid_steps.hpp"
#include "kernel/grid/packed_order.hpp"
#include "kernel/shapes/rounding.hpp"

namespace grelha {

std::vector<std::uint32_t> level_starts(std::size_t cells) {
  std::vector<std::uint32_t> first{0};
  for (std::size_t n = cells; n > 0; n = n > kBlock ? rows_of(n) : 0)
    first.push_back(first.back() + static_cast<std::uint32_t>(rows_of(n)));
  return first;
}

BoxLevelsView BoxLevels::view() const {
  BoxLevelsView v;
  v.rows = rows.data();
  v.cells = cells.data();
  v.levels = static_cast<int>(first.size());
  std::copy(first.begin(), first.end(), v.first);
  return v;
}

std::size_t box_level_bytes(std::size_t cells) {
  const std::vector<std::uint32_t> first = level_starts(cells);
  return first.back() * sizeof(BlockBoxes) + (cells + first.size() - 1) * sizeof(std::uint32_t);
}

namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

/// Sides as in BlockBoxes; empty at first.
struct FloatBox {
  float side[6] = {kNothing, kNothing, kNothing, -kNothing, -kNothing, -kNothing};

  void add(const BlockBoxes& row, std::size_t at) {
    for (int a = 0; a < 3; ++a)
      add(a, row.side[a][at], row.side[3 + a][at]);
  }
  void add(int a, float lo, float hi) {
    side[a] = std::min(side[a], lo);
    side[3 + a] = std::max(side[3 + a], hi);
  }
  void store(BlockBoxes& row, std::size_t at) const {
    for (int s = 0; s < 6; ++s)
      row.side[s][at] = side[s];
  }
};

/// A cell that holds something, and where it is.
struct OccupiedCell {
  std::uint32_t at[3];
  std::uint32_t id;  ///< of the cell
};

std::vector<OccupiedCell> occupied_cells(const Grid& g) {
  std::vector<OccupiedCell> occupied;
  occupied.reserve(g.occupied);
  std::uint32_t cell = 0;
  for (std::uint32_t z = 0; z < g.cells[2]; ++z)
    for (std::uint32_t y = 0; y < g.cells[1]; ++y)
      for (std::uint32_t x = 0; x < g.cells[0]; ++x, ++cell)
        if (g.distance[cell] == 0)
          occupied.push_back({{x, y, z}, cell});
  return occupied;
}

std::vector<std::uint32_t> ordered_cells(const Grid& g) {
  std::vector<OccupiedCell> occupied = occupied_cells(g);
  PackedOrder(g.cell).sort(std::span(occupied));
  std::vector<std::uint32_t> cells(occupied.size());
  std::transform(
      occupied.begin(), occupied.end(), cells.begin(), [](const OccupiedCell& c) { return c.id; });
  return cells;
}

bool has_other_kinds(const CellStore& store, std::size_t cell) {
  bool any = false;
  for_each_finite_shape([&]<class Shape>() {
    const auto& first = store.of<Shape>().first;
    if (!Shape::kInBlocks && !first.empty())
      any |= first[cell + 1] > first[cell];
  });
  return any;
}

FloatBox box_of_cell(const Grid& g, std::size_t cell) {
  FloatBox box;
  if (const auto& list = g.store.of<Triangle>(); !list.first.empty())
    for (std::uint32_t i = list.first[cell]; i < list.first[cell + 1]; ++i)
      box.add(list.boxes[i / kBlock], i % kBlock);
  if (!has_other_kinds(g.store, cell))
    return box;
  const CellBox whole = cell_box(g, cell);
  for (int a = 0; a < 3; ++a)
    box.add(a, float_not_above(whole.lo[a] - g.pad), float_not_below(whole.hi[a] + g.pad));
  return box;
}

/// Writes rows of so many boxes, of which box_of(i) is each; those behind them are empty.
template <class BoxOf>
void write_rows(std::size_t count, BlockBoxes* rows, const BoxOf& box_of) {
  for (std::size_t i = 0; i < rows_of(count) * kBlock; ++i)
    (i < count ? box_of(i) : FloatBox()).store(rows[i / kBlock], i % kBlock);
}

FloatBox box_of_row(const BlockBoxes& row) {
  FloatBox box;
  for (std::size_t i = 0; i < kBlock; ++i)
    box.add(row, i);
  return box;
}

}  // namespace

BoxLevels build_box_levels(const Grid& g) {
  BoxLevels levels;
  levels.cells = ordered_cells(g);
  std::vector<std::uint32_t>& first = levels.first = level_starts(levels.cells.size());
  levels.rows.resize(first.back());
  first.pop_back();
  std::size_t count = levels.cells.size();
  for (std::size_t level = 0; level < first.size(); ++level, count = rows_of(count)) {
    BlockBoxes* const rows = levels.rows.data() + first[level];
    if (level == 0)
      write_rows(count, rows, [&](std::size_t i) { return box_of_cell(g, levels.cells[i]); });
    else
      write_rows(count, rows, [&](std::size_t i) {
        return box_of_row(levels.rows[first[level - 1] + i]);
      });
  }
  return levels;
}

}  // namespace grelha
