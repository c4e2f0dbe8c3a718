#pragma once
// Uniform grids in compressed rows: cells own runs of flat arrays, the primitives themselves in
// structure-of-arrays form.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernel/primitives.hpp"
#include "kernel/raw_vector.hpp"
#include "kernel/stats.hpp"
#include "kernel/view.hpp"

namespace grelha {

class BuildProgress;

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

/// Chooses the cells of a grid over some primitives (ids ascending, at least one), M = density;
/// fill_grid() then writes its lists, and tells of its progress, which is that share of the whole.
///
/// Resolution  cells per axis = M extent / cbrt(volume / count) + 1 (Cleary & Wyvill 1988;
///             Amanatides & Woo's report form), extents below 1/1000 of the largest counted as
///             that, at most 1024 an axis, no cell smaller than 2 pad; and coarser, by halves,
///             where the mean of some primitives would stand in more than 64 cells, or, of many,
///             all in more than 2^22 (or 4 each).
/// Guarantee   every primitive stands in each cell that its box grown by `pad` touches, unless the
///             cell lies beyond `pad` of its surface; in each cell spheres and cones ascend by id,
///             triangles stand as BlockOrder says. Same lists on every machine, by any number of
///             threads.
/// Source      Lagae & Dutré, "Compact, Fast and Robust Grids for Ray Tracing", 2008: count, sum,
///             scatter. Kalojanov & Slusallek, "A Parallel Algorithm for Construction of Uniform
///             Grids", 2009: pairs of cell and primitive, sorted by cell.
Grid lay_out_grid(const Primitives& primitives,
                  std::span<const std::uint32_t> ids,
                  const Box& box,
                  double density,
                  double pad);
void fill_grid(const Primitives& primitives,
               std::span<const std::uint32_t> ids,
               Grid& grid,
               int threads,
               BuildProgress& progress,
               double share);

/// The edge of the cells that a density asks for; what lay_out_grid() makes of it also depends on
/// the pad.
double cell_edge(const Box& box, std::size_t count, double density);

/// Box of some finite primitives, and the longest diagonal of any.
struct Extent {
  Box box;
  double longest = 0;
};
Extent extent_of(const Primitives& primitives, std::span<const std::uint32_t> ids, int threads);
/// Those of `ids` whose box has a longer diagonal, ascending; most + 1 of them, whichever, when
/// there are more than `most`.
std::vector<std::uint32_t> longer_than(const Primitives& primitives,
                                       std::span<const std::uint32_t> ids,
                                       double diagonal,
                                       std::size_t most,
                                       int threads);

/// A box for each block of triangles of one cell: of the part of them within the cell. Both are
/// grown by `pad` as when triangles are given to cells, and by a quarter more for the rounding of a
/// test of it.
void bound_blocks(const Grid& grid,
                  double pad,
                  std::size_t cell,
                  std::uint32_t first,
                  std::uint32_t end,
                  CellStore& store);

/// All of `ids` as the one cell of a store without a grid.
CellStore build_list(const Primitives& primitives, std::span<const std::uint32_t> ids);

/// Chebyshev distance of each cell to the nearest with occupied != 0, at most 255; exact.
///
/// Method  the least of max(|dx|, |dy|, |dz|) taken along x, then y, then z, so that each step
///         reads whole rows of bytes and threads share nothing.
std::vector<std::uint8_t> chebyshev_distance(const std::vector<std::uint8_t>& occupied,
                                             const std::array<std::uint32_t, 3>& cells);
/// In place: `d` holds 0 where a cell is occupied and 255 elsewhere.
void chebyshev_distance(std::vector<std::uint8_t>& d,
                        const std::array<std::uint32_t, 3>& cells,
                        int threads);

}  // namespace grelha
