#pragma once
// Boxes of blocks of triangles.

#include <cstddef>
#include <cstdint>

#include "kernel/grid/grid.hpp"

namespace grelha {

/// Turns how many blocks cells [begin, end) have into where their boxes begin, from a row on whose
/// first is that of `block`. Returns the row behind the last.
std::uint64_t place_boxes(std::size_t begin,
                          std::size_t end,
                          std::uint64_t row,
                          std::uint64_t block,
                          ListStore<Triangle>& store);

/// A box for each block of the triangles of one cell: of the part of them within the cell. Both are
/// grown by `pad` as when triangles are given to cells, and by a quarter more for the rounding of a
/// test of it.
void bound_blocks(const Grid& grid,
                  double pad,
                  std::size_t cell,
                  std::uint32_t triangles,
                  ListStore<Triangle>& store);

}  // namespace grelha
