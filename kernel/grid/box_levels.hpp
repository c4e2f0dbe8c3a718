#pragma once
// A hierarchy of bounding boxes over the cells of a grid that hold something.

#include <cstdint>
#include <vector>

#include "kernel/base/raw_vector.hpp"
#include "kernel/grid/view.hpp"

namespace grelha {

struct Grid;

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

/// Builds the levels of a grid whose lists and distances are there. The box of a cell bounds those
/// of its blocks of triangles, or is the cell, grown by the grid's pad, where it holds others.
BoxLevels build_box_levels(const Grid& grid);

}  // namespace grelha
