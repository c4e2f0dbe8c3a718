#pragma once
// Uniform grids in compressed rows: cells own runs of flat arrays, the primitives themselves in
// structure-of-arrays form.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "grelha/stats.hpp"
#include "kernel/grid/box_levels.hpp"
#include "kernel/grid/cell_store.hpp"
#include "kernel/grid/distance_field.hpp"
#include "kernel/grid/view.hpp"
#include "kernel/shapes/primitives.hpp"

namespace grelha {

struct Grid {
  std::array<std::uint32_t, 3> cells{1, 1, 1};  ///< per axis, each >= 1; x runs fastest
  double pad = 0;                               ///< added around primitives
  /// corner (a float's value, so that walks subtract it exactly) and cell size
  double lo[3] = {}, cell[3] = {};
  bool stretched = false;  ///< rays walk it one by one: slices of few long cells part no packet
  CellStore store;
  std::vector<std::uint8_t> distance;  ///< of cells, see distance_field.hpp
  BoxLevels levels;                    ///< of the cells that hold something
  std::uint64_t occupied = 0;
  double near_distance =
      0;  ///< how far from their box rays start that walk it from where they start

  GridView view() const;
  GridStats stats() const;
  /// True if it has the cells of another, and rays walk it alike.
  bool has_layout_of(const Grid& o) const;

 private:
  void set_axis(GridView& v, int a) const;
  void set_error_bounds(GridView& v) const;
};

/// A cell, in scene units.
struct CellBox {
  double lo[3], hi[3];
};
CellBox cell_box(const Grid& g, std::size_t cell);

/// Index along one axis of the cell that holds x: the one rule, for building and for walking.
inline int cell_of(double x, double lo, double inv_cell, int n) {
  const double at = (x - lo) * inv_cell;
  if (!(at > 0))
    return 0;
  const int i = static_cast<int>(at < n ? at : n);
  return i < n ? i : n - 1;
}

}  // namespace grelha
