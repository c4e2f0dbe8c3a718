#pragma once
// Chooses the cells of grids.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "kernel/grid/grid.hpp"
#include "kernel/shapes/primitives.hpp"

namespace grelha {

/// Threads that have enough to do: starting one costs as much as some hundred primitives.
inline int thread_count_for(int threads, std::size_t work) {
  return static_cast<int>(
      std::clamp<std::size_t>(work / 512, 1, static_cast<std::size_t>(threads)));
}

/// Chooses the cells of a grid over some primitives (ids ascending, at least one), M = density.
/// fill_grid() then writes its lists, and reports its share of the whole.
///
/// Resolution  cells per axis = M extent / cbrt(volume / count) + 1 (Cleary & Wyvill 1988;
///             Amanatides & Woo's report form). Extents below 1/1000 of the largest count as that.
///             At most 1024 cells an axis, none smaller than 2 pad. Cells are coarsened by halves
///             if primitives of a probe would stand in more than 64 cells on average, or all
///             primitives together in more than 2^22 (or 4 each).
/// Stretch     Where the mean primitive would stand in more than 16 cells, as sheets do, these move
///             from axis to axis by factors of two. A ray is expected to cost 64 + visits (8 +
///             references of a cell). It crosses the planes of an axis by the area of the grid
///             across it, on 1 / (1 + boxes met) of its way; a hundredth of rays go all of it.
/// Guarantee   every primitive stands in each cell that its box grown by `pad` overlaps, unless the
///             cell lies beyond `pad` of its surface. In each cell spheres and cones ascend by id,
///             triangles stand as BlockOrder says. Same lists on every machine, by any number of
///             threads.
/// Source      Lagae & Dutré, "Compact, Fast and Robust Grids for Ray Tracing", 2008: count, sum,
///             scatter. Kalojanov & Slusallek, "A Parallel Algorithm for Construction of Uniform
///             Grids", 2009: pairs of cell and primitive, sorted by cell.
Grid layout_grid(const Primitives& primitives,
                 std::span<const std::uint32_t> ids,
                 const Box& box,
                 double density,
                 double pad);

/// The edge of the cells that a density asks for; what layout_grid() makes of it also depends on
/// the pad.
double cell_edge(const Box& box, std::size_t count, double density);

/// Box of some finite primitives, and the longest diagonal of any.
struct Extent {
  Box box;
  double longest = 0;
};
Extent extent_of(const Primitives& primitives, std::span<const std::uint32_t> ids, int threads);
/// Returns the `ids` whose box has a longer diagonal, ascending; if there are more than `most`, any
/// most + 1 such ids.
std::vector<std::uint32_t> longer_than(const Primitives& primitives,
                                       std::span<const std::uint32_t> ids,
                                       double diagonal,
                                       std::size_t most,
                                       int threads);

}  // namespace grelha
