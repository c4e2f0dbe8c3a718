#include "kernel/grid/grid.hpp"

#include <limits>

namespace grelha {

CellLists CellStore::lists() const {
  CellLists l;
  if (!triangle_first.empty()) {
    l.triangle_first = triangle_first.data();
    l.triangles = triangles.data();
    l.boxes = boxes.empty() ? nullptr : boxes.data();
  }
  if (!sphere_first.empty()) {
    l.sphere_first = sphere_first.data();
    l.sx = spheres[0].data();
    l.sy = spheres[1].data();
    l.sz = spheres[2].data();
    l.sr = spheres[3].data();
    l.sphere_id = sphere_id.data();
  }
  if (!cone_first.empty()) {
    l.cone_first = cone_first.data();
    l.cone_id = cone_id.data();
    for (std::size_t k = 0; k < 10; ++k)
      l.cone[k] = cones[k].data();
  }
  return l;
}

std::size_t CellStore::bytes() const {
  std::size_t sum = bytes_of(triangle_first) + bytes_of(sphere_first) + bytes_of(cone_first) +
                    bytes_of(triangles) + bytes_of(boxes) + bytes_of(sphere_id) + bytes_of(cone_id);
  for (const auto& v : spheres)
    sum += bytes_of(v);
  for (const auto& v : cones)
    sum += bytes_of(v);
  return sum;
}

GridView Grid::view() const {
  GridView v;
  v.lists = store.lists();
  v.serves = serves;
  v.distance = distance.data();
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
