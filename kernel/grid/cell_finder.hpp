#pragma once
// Which cells of a grid a primitive overlaps.

#include "kernel/grid/grid.hpp"

namespace grelha {

/// Calls visit(cell) for every cell a primitive is to stand in, ascending.
class CellFinder {
 public:
  CellFinder(const Primitives& p, const Grid& g) : primitives_(p), grid_(g) {
    frame_.pad = g.pad;
    for (int a = 0; a < 3; ++a) {
      frame_.lo[a] = g.lo[a];
      frame_.cell[a] = g.cell[a];
      inverse_[a] = 1 / g.cell[a];
    }
  }

  template <class Visit>
  void operator()(std::uint32_t id, const Visit& visit) const {
    primitives_.visit(id, [&]<class Shape>(std::uint32_t i) {
      const auto& all = primitives_.of<Shape>();
      const CellRange range = cells_of(Shape::box(all, i));
      if (range.is_one())
        visit(index(range.lo[0], range.lo[1], range.lo[2]));
      else
        visit_overlapped(range, typename Shape::Overlap(all[i], frame_, range), visit);
    });
  }

 private:
  CellRange cells_of(const Box& box) const {
    CellRange range;
    for (int a = 0; a < 3; ++a) {
      const int n = static_cast<int>(grid_.cells[static_cast<std::size_t>(a)]);
      range.lo[a] = cell_of(box.lo[a] - frame_.pad, frame_.lo[a], inverse_[a], n);
      range.hi[a] = cell_of(box.hi[a] + frame_.pad, frame_.lo[a], inverse_[a], n);
    }
    return range;
  }
  std::size_t index(int x, int y, int z) const {
    const std::size_t nx = grid_.cells[0];
    const std::size_t ny = grid_.cells[1];
    return static_cast<std::size_t>(x) + nx * static_cast<std::size_t>(y) +
           nx * ny * static_cast<std::size_t>(z);
  }
  template <class Overlap, class Visit>
  void visit_overlapped(const CellRange& range, const Overlap& overlaps, const Visit& visit) const {
    for (int z = range.lo[2]; z <= range.hi[2]; ++z)
      for (int y = range.lo[1]; y <= range.hi[1]; ++y)
        for (int x = range.lo[0]; x <= range.hi[0]; ++x)
          if (overlaps({x, y, z}))
            visit(index(x, y, z));
  }

  const Primitives& primitives_;
  const Grid& grid_;
  CellFrame frame_;
  double inverse_[3];
};

}  // namespace grelha
