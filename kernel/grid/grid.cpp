#include "kernel/grid/grid.hpp"

#include <cmath>

namespace grelha {

GridView Grid::view() const {
  GridView v;
  v.lists = store.lists();
  v.serves = serves;
  v.distance = distance.data();
  v.pad = static_cast<float>(pad);
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    v.n[a] = static_cast<int>(cells[i]);
    v.near_lo[a] = near_lo[a];
    v.near_hi[a] = near_hi[a];
    v.lo[a] = lo[a];
    v.cell[a] = cell[a];
    v.inv_cell[a] = 1 / cell[a];
    v.lo_f[a] = static_cast<float>(lo[a]);
    v.hi_f[a] = static_cast<float>(lo[a] + cell[a] * cells[i]);
    v.hi_f[a] += std::abs(v.hi_f[a]) * 1.2e-7f;
    v.cell_f[a] = static_cast<float>(cell[a]);
    v.inv_cell_f[a] = static_cast<float>(1 / cell[a]);
  }
  return v;
}

GridStats Grid::stats() const {
  return {cells, occupied, store.references, store.bytes() + bytes_of(distance)};
}

}  // namespace grelha
