#pragma once
// Writes the lists of grids.

#include <cstdint>
#include <span>

#include "kernel/grid/build_progress.hpp"
#include "kernel/grid/grid.hpp"
#include "kernel/shapes/primitives.hpp"

namespace grelha {

/// Writes the lists of a grid whose cells layout_grid() chose, and reports progress, `share` of
/// the whole.
void fill_grid(const Primitives& primitives,
               std::span<const std::uint32_t> ids,
               Grid& grid,
               int threads,
               BuildProgress& progress,
               double share);

/// All of `ids` as the one cell of a store without a grid.
CellStore build_list(const Primitives& primitives, std::span<const std::uint32_t> ids);

}  // namespace grelha
