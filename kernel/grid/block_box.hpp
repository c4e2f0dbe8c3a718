#pragma once
// Boxes of blocks of triangles.

#include <cstddef>
#include <cstdint>

#include "kernel/grid/grid.hpp"

namespace grelha {

/// Replaces the numbers of blocks in cells [begin, end) by the positions where their boxes begin,
/// from `row` on, whose first box is that of `block`. Returns the row behind the last.
std::uint64_t write_boxes(std::size_t begin,
                          std::size_t end,
                          std::uint64_t row,
                          std::uint64_t block,
                          ListStore<Triangle>& store);

/// Computes a box for each block of the triangles of one cell: their bounds within the cell. Bounds
/// and cell are grown by `pad`, as when triangles are given to cells, and the box by a quarter more
/// for the rounding of its slab test.
void bound_blocks(const Grid& grid,
                  double pad,
                  std::size_t cell,
                  std::uint32_t triangles,
                  ListStore<Triangle>& store);

/// Sets box `at` of a row to the bounds of a block.
void set_bounds(const TriangleBlock& block, BlockBoxes& row, std::size_t at);

}  // namespace grelha
