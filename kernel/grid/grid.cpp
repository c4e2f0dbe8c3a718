#include "kernel/grid/grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/shapes/rounding.hpp"

namespace grelha {
namespace {

constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();
constexpr float kNowhere = std::numeric_limits<float>::infinity();

}  // namespace

void ListStore<Triangle>::resize_boxes(std::size_t rows) {
  boxes.resize(rows);
  first_block.resize(rows + 1);
  first_block[rows] = static_cast<std::uint32_t>(blocks.size());
}

void ListStore<Triangle>::end_row(std::size_t place) {
  constexpr float kNowhere = std::numeric_limits<float>::infinity();
  for (; place % kBlock != 0; ++place)
    for (int a = 0; a < 3; ++a) {
      boxes[place / kBlock].side[a][place % kBlock] = kNowhere;
      boxes[place / kBlock].side[3 + a][place % kBlock] = -kNowhere;
    }
}

void ListStore<Triangle>::put(std::size_t entry,
                              std::size_t place,
                              const Triangle::Fields<float>& triangle,
                              std::uint32_t of) {
  TriangleBlock& block = blocks[entry + place / kBlock];
  const std::size_t at = place % kBlock;
  for (int a = 0; a < 3; ++a) {
    block.a[a][at] = triangle.corner[0][a];
    block.b[a][at] = triangle.corner[1][a];
    block.c[a][at] = triangle.corner[2][a];
  }
  block.id[at] = of;
}

void ListStore<Triangle>::end_block(std::size_t entry, std::size_t place) {
  TriangleBlock& block = blocks[entry + place / kBlock];
  for (std::size_t i = place % kBlock; i < kBlock; ++i) {
    for (int a = 0; a < 3; ++a)
      block.a[a][i] = block.b[a][i] = block.c[a][i] = kNoNumber;
    block.id[i] = kNoPrimitive;
  }
}

Triangle::CellList ListStore<Triangle>::list() const {
  if (first.empty())
    return {};
  return {
      first.data(),
      blocks.data(),
      boxes.empty() ? nullptr : boxes.data(),
      boxes.empty() ? nullptr : first_block.data(),
  };
}

CellLists CellStore::lists() const {
  CellLists l;
  for_each_finite_shape([&]<class Shape>() {
    static_cast<typename Shape::CellList&>(l.of<Shape>()) = of<Shape>().list();
  });
  return l;
}

std::size_t CellStore::bytes() const {
  std::size_t sum = 0;
  for_each_finite_shape([&]<class Shape>() { sum += of<Shape>().bytes(); });
  return sum;
}

CellBox cell_box(const Grid& g, std::size_t cell) {
  const std::size_t nx = g.cells[0];
  const std::size_t ny = g.cells[1];
  const std::size_t at[3] = {cell % nx, cell / nx % ny, cell / nx / ny};
  CellBox box;
  for (int a = 0; a < 3; ++a) {
    box.lo[a] = g.lo[a] + static_cast<double>(at[a]) * g.cell[a];
    box.hi[a] = g.lo[a] + static_cast<double>(at[a] + 1) * g.cell[a];
  }
  return box;
}

GridView Grid::view() const {
  GridView v;
  v.lists = store.lists();
  v.levels = levels.view();
  v.distance = distance.data();
  const std::size_t count = cell_count(cells);
  v.field_stride = distance_fields(count) > 1 ? static_cast<std::uint32_t>(count) : 0;
  v.pad = static_cast<float>(pad);
  v.stretched = stretched;
  for (int a = 0; a < 3; ++a)
    set_axis(v, a);
  set_error_bounds(v);
  return v;
}

// Rays that start near by are no further from a primitive, along each axis, than the grid is long
// and the near distance; one is no larger than the grid. In the grid's frame a coordinate of a ray
// and one of a primitive round by u of these each.
void Grid::set_error_bounds(GridView& v) const {
  constexpr double kUnit = 0x1p-24;
  double far = 0;
  double longest = 0;
  for (int a = 0; a < 3; ++a) {
    const double extent = cell[a] * v.n[a];
    far += extent + near_distance;
    longest = std::max(longest, extent);
  }
  v.error_bound = float_not_below(17 * kUnit * (far + longest));
  v.frame_error = float_not_below(4 * kUnit * (longest + near_distance));
}

void Grid::set_axis(GridView& v, int a) const {
  const std::uint32_t n = cells[static_cast<std::size_t>(a)];
  v.n[a] = static_cast<int>(n);
  v.near_lo[a] = -float_not_above(-(lo[a] - near_distance));
  v.near_hi[a] = float_not_above(lo[a] + cell[a] * n + near_distance);
  v.lo[a] = lo[a];
  v.cell[a] = cell[a];
  v.inv_cell[a] = 1 / cell[a];
  v.lo_f[a] = static_cast<float>(lo[a]);
  v.hi_f[a] = float_not_below(lo[a] + cell[a] * n);
  v.cell_f[a] = static_cast<float>(cell[a]);
  v.inv_cell_f[a] = static_cast<float>(1 / cell[a]);
}

bool Grid::has_layout_of(const Grid& o) const {
  return cells == o.cells && pad == o.pad && std::ranges::equal(lo, o.lo) &&
         std::ranges::equal(cell, o.cell) && stretched == o.stretched &&
         near_distance == o.near_distance;
}

GridStats Grid::stats() const {
  return {
      cells,
      occupied,
      store.references,
      store.bytes() + bytes_of(distance) + levels.bytes(),
  };
}

}  // namespace grelha
