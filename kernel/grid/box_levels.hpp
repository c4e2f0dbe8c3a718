#pragma once
// A hierarchy of bounding boxes over the cells of a grid that hold something.

#include <cstdint>
#include <vector>

#include "kernel/base/raw_vector.hpp"
#include "kernel/grid/view.hpp"

namespace grelha {

/// A tree of eight children a node, without pointers: eight cells that follow each other in space
/// share a row of boxes, eight rows a row of the next level, up to a single one. So box k of row r
/// bounds row 8 r + k of the level below, or the cell that stands at 8 r + k.
///
/// Source  Kamel & Faloutsos, "On Packing R-trees", 1993; the order is that of a bisection.
struct BoxLevels {
  RawVector<BlockBoxes> rows;        ///< level after level, the cells' first
  std::vector<std::uint32_t> cells;  ///< in the order of their boxes
  std::vector<std::uint32_t> first;  ///< [levels] first row of each

  BoxLevelsView view() const;
  std::size_t bytes() const { return bytes_of(rows) + bytes_of(cells) + bytes_of(first); }
};

/// Bytes of the levels over so many cells.
std::size_t box_level_bytes(std::size_t cells);

inline std::size_t rows_of(std::size_t boxes) {
  return (boxes + kBlock - 1) / kBlock;
}
/// Rows at which the levels over so many cells begin, and where all end.
std::vector<std::uint32_t> level_starts(std::size_t cells);

}  // namespace grelha
