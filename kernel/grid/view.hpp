#pragma once
// A built scene as plain pointers: all that the hot loops see. No containers here, whose members
// would be shared between the copies of the kernel.

#include <cstdint>

#include "grelha/rays.hpp"
#include "kernel/shapes/shapes.hpp"

namespace grelha {

template <class Shape>
struct CellListOf : Shape::CellList {};

/// Cells of one grid, one after the other, each kind apart.
struct CellLists : PerShape<CellListOf, FiniteShapes> {};

inline constexpr int kMostGrids = 17;

/// Boxes over cells, eight a node; see grid.hpp.
struct BoxLevelsView {
  static constexpr int kMostLevels = 11;  ///< of 8^11 = 2^33 cells
  const BlockBoxes* rows = nullptr;
  const std::uint32_t* cells = nullptr;
  std::uint32_t first[kMostLevels] = {};  ///< row of each level; of the last there is one
  int levels = 0;
};

struct GridView {
  CellLists lists;
  BoxLevelsView levels;
  /// rays that start outside of this box are moved into the frame of the grid first
  float near_lo[3] = {}, near_hi[3] = {};
  float error_bound = 0;  ///< SimdRays::error_bound of rays that start within it
  float frame_error = 0;  ///< error of coordinates in the frame of the grid
  /// [cells] Chebyshev distance to the nearest cell that holds something; 0: this one does. Behind
  /// it fields of [cells] by octants of directions, each so many bytes after the one before, or 0:
  /// there are none.
  const std::uint8_t* distance = nullptr;
  std::uint32_t field_stride = 0;
  int n[3] = {};  ///< cells per axis; x runs fastest
  double lo[3] = {}, cell[3] = {}, inv_cell[3] = {};
  float pad = 0;           ///< added around primitives before they were put into cells
  bool stretched = false;  ///< rays walk it one by one, see Grid
  float lo_f[3] = {}, hi_f[3] = {}, cell_f[3] = {}, inv_cell_f[3] = {};
};

/// The primitives that rays can hit, and their grids.
struct SceneView {
  GeometryView geometry;
  /// one "cell" of primitives that no grid holds: few, or as large as the scene
  CellLists outside;
  BlockBoxes outside_boxes = {};  ///< bounds of its first blocks of triangles
  const GridView* grids = nullptr;
  int grid_count = 0;
  float box_lo[3] = {}, box_hi[3] = {};  ///< of all finite primitives
  bool finite = false;                   ///< there is something besides planes
  CopyTable copies;                      ///< of primitives that stand nowhere else
};

/// How rays are traced. Only masks change an answer.
struct TraceOptions {
  int packet = 256;                     ///< rays that walk together: 1, 16, 64 or 256
  bool mailbox = true;                  ///< for packets
  const std::uint8_t* masks = nullptr;  ///< [primitives], see RayFilter
};

}  // namespace grelha
