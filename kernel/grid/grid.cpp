#include "kernel/grid/grid.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/shapes/rounding.hpp"

namespace grelha {

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
