#pragma once
// Builds the levels of boxes over a grid's cells.

#include "kernel/grid/box_levels.hpp"
#include "kernel/grid/grid.hpp"

namespace grelha {

/// Builds the levels of a grid whose lists and distances are there. The box of a cell bounds those
/// of its blocks of triangles, or is the cell, grown by the grid's pad, where it holds others.
BoxLevels build_box_levels(const Grid& grid);

}  // namespace grelha
