#pragma once
// Boxes of blocks of triangles.

#include <cstddef>
#include <cstdint>

#include "kernel/grid/grid.hpp"

namespace grelha {

/// A box for each block of triangles of one cell: of the part of them within the cell. Both are
/// grown by `pad` as when triangles are given to cells, and by a quarter more for the rounding of a
/// test of it.
void bound_blocks(const Grid& grid,
                  double pad,
                  std::size_t cell,
                  std::uint32_t first,
                  std::uint32_t end,
                  ListStore<Triangle>& store);

}  // namespace grelha
