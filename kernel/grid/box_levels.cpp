#include "kernel/grid/box_levels.hpp"

#include <algorithm>
#include <limits>

#include "kernel/grid/grid.hpp"
#include "kernel/shapes/rounding.hpp"

namespace grelha {
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

/// Cells of a grid, first to last along each axis.
struct CellRun {
  std::uint32_t first[3], end[3];
  std::uint32_t size(int a) const { return end[a] - first[a]; }
};

/// Lists the cells that hold something, neighbours near each other: halves the grid across its
/// longest side, then each half.
class CellOrder {
 public:
  explicit CellOrder(const Grid& grid) : g_(grid) {
    cells_.reserve(grid.occupied);
    take({{0, 0, 0}, {g_.cells[0], g_.cells[1], g_.cells[2]}});
  }
  std::vector<std::uint32_t> cells() && { return std::move(cells_); }

 private:
  /// As deep as the numbers of cells have bits together.
  void take(const CellRun& run) {
    const std::size_t cell = run.first[0] + std::size_t{g_.cells[0]} *
                                                (run.first[1] + std::size_t{g_.cells[1]} *
                                                                    run.first[2]);
    const std::uint32_t most = std::max({run.size(0), run.size(1), run.size(2)});
    if (g_.distance[cell] >= most)
      return;  // nothing is so near to this corner
    if (most == 1)
      return cells_.push_back(static_cast<std::uint32_t>(cell));
    const int across = longest_side(run);
    const std::uint32_t middle = run.first[across] + run.size(across) / 2;
    CellRun below = run, above = run;
    below.end[across] = above.first[across] = middle;
    take(below);
    take(above);
  }

  int longest_side(const CellRun& run) const {
    const auto length = [&](int a) { return run.size(a) > 1 ? run.size(a) * g_.cell[a] : 0.; };
    int longest = 0;
    for (int a = 1; a < 3; ++a)
      if (length(a) > length(longest))
        longest = a;
    return longest;
  }

  const Grid& g_;
  std::vector<std::uint32_t> cells_;
};

bool holds_others(const CellStore& store, std::size_t cell) {
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
  if (!holds_others(g.store, cell))
    return box;
  const CellBox whole = cell_box(g, cell);
  for (int a = 0; a < 3; ++a)
    box.add(a, float_not_above(whole.lo[a] - g.pad), float_not_below(whole.hi[a] + g.pad));
  return box;
}

std::size_t rows_of(std::size_t boxes) {
  return (boxes + kBlock - 1) / kBlock;
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

/// Where each level begins, and all end.
std::vector<std::uint32_t> level_starts(std::size_t cells) {
  std::vector<std::uint32_t> first{0};
  for (std::size_t n = cells; n > 0; n = n > kBlock ? rows_of(n) : 0)
    first.push_back(first.back() + static_cast<std::uint32_t>(rows_of(n)));
  return first;
}

}  // namespace

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

BoxLevels build_box_levels(const Grid& g) {
  BoxLevels levels;
  levels.cells = CellOrder(g).cells();
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
