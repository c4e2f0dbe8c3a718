#pragma once
// Runs of primitives, cell after cell, that own the memory a CellLists points to.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "kernel/grid/view.hpp"
#include "kernel/base/raw_vector.hpp"
#include "kernel/shapes/shapes.hpp"

namespace grelha {

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

}  // namespace grelha
