#pragma once
// Uniform grids in compressed rows: cells own runs of flat arrays, the primitives themselves in
// structure-of-arrays form.

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "grelha/stats.hpp"
#include "kernel/base/raw_vector.hpp"
#include "kernel/grid/view.hpp"
#include "kernel/shapes/shapes.hpp"
#include "kernel/grid/distance_field.hpp"
#include "kernel/shapes/primitives.hpp"

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

// Uniform grids in compressed rows: cells own runs of flat arrays, the primitives themselves in
// structure-of-arrays form.

/// The primitives of one kind: an entry each, their numbers in rows, one row a field. Rows end in
/// kBlock entries of NaN, so that a whole block can be read from any element. All rows are one
/// piece of memory: pieces of their own would be too small for large pages.
template <class Shape>
struct ListStore {
  /// Bytes of an entry.
  static constexpr std::size_t kEntry = sizeof(typename Shape::template Fields<float>) + 4;

  /// [cells + 1] where each cell's begin; empty where no cell holds any
  RawVector<std::uint32_t> first;
  RawVector<float> rows;
  RawVector<std::uint32_t> id;

  static std::uint32_t entries_of(std::uint32_t primitives) { return primitives; }
  void resize(std::size_t entries) {
    id.resize(entries + kBlock);
    std::fill(id.begin() + static_cast<std::ptrdiff_t>(entries), id.end(), kNoPrimitive);
    rows.resize(id.size() * kFields);
    for (std::size_t row = 0; row < kFields; ++row)
      std::fill_n(
          rows.data() + row * id.size() + entries, kBlock, std::numeric_limits<float>::quiet_NaN());
  }
  void put(std::size_t entry, const typename Shape::template Fields<float>& one, std::uint32_t of) {
    float* place = rows.data() + entry;
    const auto put_number = [&](const float& x) {
      *place = x;
      place += id.size();
    };
    Shape::for_each_field(put_number, one);
    id[entry] = of;
  }
  typename Shape::CellList list() const {
    typename Shape::CellList out;
    if (first.empty())
      return out;
    const float* row = rows.data();
    const auto point_to = [&](const float*& to) {
      to = row;
      row += id.size();
    };
    Shape::for_each_field(point_to, out.fields);
    out.first = first.data();
    out.id = id.data();
    return out;
  }
  std::size_t bytes() const { return bytes_of(first) + id.size() * kEntry; }

 private:
  static constexpr std::size_t kFields = kEntry / sizeof(float) - 1;
};

/// Triangles: an entry is a block of triangles.
template <>
struct ListStore<Triangle> {
  static constexpr std::size_t kEntry = sizeof(TriangleBlock);

  RawVector<std::uint32_t> first;
  RawVector<TriangleBlock> blocks;
  RawVector<BlockBoxes> boxes;           ///< of all blocks, or none
  RawVector<std::uint32_t> first_block;  ///< [rows + 1] of each row of boxes, and where all end

  static std::uint32_t entries_of(std::uint32_t primitives) {
    return (primitives + kBlock - 1) / kBlock;
  }
  void resize(std::size_t entries) { blocks.resize(entries); }
  /// Once blocks have their room.
  void resize_boxes(std::size_t rows);
  /// No block has a box of this row from a position on, if that is within it.
  void end_row(std::size_t place);
  /// Puts a triangle at one of the positions of blocks from `entry` on.
  void put(std::size_t entry, std::size_t place, const Triangle::Fields<float>&, std::uint32_t of);
  /// The last block holds nothing from a position on.
  void end_block(std::size_t entry, std::size_t place);
  Triangle::CellList list() const;
  std::size_t bytes() const {
    return bytes_of(first) + bytes_of(blocks) + bytes_of(boxes) + bytes_of(first_block);
  }
};

/// The primitives of cells, each kind apart.
struct CellStore : PerShape<ListStore, FiniteShapes> {
  std::uint64_t references = 0;
  std::vector<Copy> copies;  ///< what was dropped, since something in the same cells equals it

  CellLists lists() const;
  std::size_t bytes() const;
};

struct Grid {
  std::array<std::uint32_t, 3> cells{1, 1, 1};  ///< per axis, each >= 1; x runs fastest
  double pad = 0;                               ///< added around primitives
  /// corner (a float's value, so that walks subtract it exactly) and cell size
  double lo[3] = {}, cell[3] = {};
  bool stretched = false;  ///< rays walk it one by one: slices of few long cells part no packet
  CellStore store;
  std::vector<std::uint8_t> distance;  ///< of cells, see distance_field.hpp
  BoxLevels levels;                    ///< of the cells that hold something
  std::uint64_t occupied = 0;
  double near_distance =
      0;  ///< how far from their box rays start that walk it from where they start

  GridView view() const;
  GridStats stats() const;
  /// True if it has the cells of another, and rays walk it alike.
  bool has_layout_of(const Grid& o) const;

 private:
  void set_axis(GridView& v, int a) const;
  void set_error_bounds(GridView& v) const;
};

/// A cell, in scene units.
struct CellBox {
  double lo[3], hi[3];
};
CellBox cell_box(const Grid& g, std::size_t cell);

/// Index along one axis of the cell that holds x: the one rule, for building and for walking.
inline int cell_of(double x, double lo, double inv_cell, int n) {
  const double at = (x - lo) * inv_cell;
  if (!(at > 0))
    return 0;
  const int i = static_cast<int>(at < n ? at : n);
  return i < n ? i : n - 1;
}

}  // namespace grelha
