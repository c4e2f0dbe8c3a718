#pragma once
// Uniform grids in compressed rows: cells own runs of flat arrays, the primitives themselves in
// structure-of-arrays form.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernel/shapes/primitives.hpp"
#include "kernel/scene/raw_vector.hpp"
#include "grelha/stats.hpp"
#include "kernel/grid/view.hpp"

namespace grelha {

inline std::size_t cell_count(const std::array<std::uint32_t, 3>& cells) {
  return std::size_t{cells[0]} * cells[1] * cells[2];
}

/// Runs of primitives, cell after cell, that own the memory a CellLists points to.
struct CellStore {
  RawVector<std::uint32_t> triangle_first, sphere_first, cone_first;
  RawVector<TriangleBlock> triangles;
  RawVector<BlockBoxes> boxes;
  std::array<RawVector<float>, 4> spheres;
  RawVector<std::uint32_t> sphere_id;
  std::array<RawVector<float>, 10> cones;
  RawVector<std::uint32_t> cone_id;
  std::uint64_t references = 0;

  CellLists lists() const;
  std::size_t bytes() const;
};

struct Grid {
  std::array<std::uint32_t, 3> cells{1, 1, 1};  ///< per axis, each >= 1; x runs fastest
  double pad = 0;                               ///< what primitives were grown by
  /// corner (a float's value, so that walks subtract it exactly) and cell size
  double lo[3] = {}, cell[3] = {};
  CellStore store;
  /// [cells + 3] Chebyshev distance to the nearest non-empty cell, at most 255
  std::vector<std::uint8_t> distance;
  std::uint64_t occupied = 0;
  Serves serves = Serves::kAll;
  float near_lo[3] = {}, near_hi[3] = {};  ///< see Serves

  GridView view() const;
  GridStats stats() const;
};

/// Index along one axis of the cell that holds x: the one rule, for building and for walking.
inline int cell_of(double x, double lo, double inv_cell, int n) {
  const double at = (x - lo) * inv_cell;
  if (!(at > 0))
    return 0;
  const int i = static_cast<int>(at < n ? at : n);
  return i < n ? i : n - 1;
}

}  // namespace grelha
