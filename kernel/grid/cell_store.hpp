#pragma once
// Runs of primitives, cell after cell, that own the memory a CellLists points to.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "kernel/grid/view.hpp"
#include "kernel/scene/raw_vector.hpp"
#include "kernel/shapes/shapes.hpp"

namespace grelha {

/// The primitives of one kind: an entry each, their numbers in arrays of their own. Arrays end in
/// kBlock entries of NaN, so that a whole block can be read from any place.
template <class Shape>
struct ListStore {
  /// Bytes of an entry.
  static constexpr std::size_t kEntry = sizeof(typename Shape::template Fields<float>) + 4;

  /// [cells + 1] where each cell's begin; empty where no cell holds any
  RawVector<std::uint32_t> first;
  typename Shape::template Fields<RawVector<float>> fields;
  RawVector<std::uint32_t> id;

  static std::uint32_t entries_of(std::uint32_t primitives) { return primitives; }
  void resize(std::size_t entries) {
    pad(id, entries, kNoPrimitive);
    const auto pad_array = [&](RawVector<float>& v) {
      pad(v, entries, std::numeric_limits<float>::quiet_NaN());
    };
    Shape::for_each_field(pad_array, fields);
  }
  void put(std::size_t entry, const typename Shape::template Fields<float>& one, std::uint32_t of) {
    const auto put_number = [&](RawVector<float>& v, const float& x) { v[entry] = x; };
    Shape::for_each_field(put_number, fields, one);
    id[entry] = of;
  }
  typename Shape::CellList list() const {
    typename Shape::CellList out;
    if (first.empty())
      return out;
    const auto point_to = [](const float*& to, const RawVector<float>& from) { to = from.data(); };
    Shape::for_each_field(point_to, out.fields, fields);
    out.first = first.data();
    out.id = id.data();
    return out;
  }
  std::size_t bytes() const { return bytes_of(first) + id.size() * kEntry; }

 private:
  template <class T>
  static void pad(RawVector<T>& v, std::size_t entries, T with) {
    v.resize(entries + kBlock);
    std::fill(v.begin() + static_cast<std::ptrdiff_t>(entries), v.end(), with);
  }
};

/// Triangles: an entry is a block of them.
template <>
struct ListStore<Triangle> {
  static constexpr std::size_t kEntry = sizeof(TriangleBlock);

  RawVector<std::uint32_t> first;
  RawVector<TriangleBlock> blocks;
  RawVector<BlockBoxes> boxes;  ///< of all blocks, or none

  static std::uint32_t entries_of(std::uint32_t primitives) {
    return (primitives + kBlock - 1) / kBlock;
  }
  void resize(std::size_t entries) { blocks.resize(entries); }
  void resize_boxes();
  /// Puts a triangle in one of the places of blocks from `entry` on.
  void put(std::size_t entry, std::size_t place, const Triangle::Fields<float>&, std::uint32_t of);
  /// The last block holds nothing from a place on.
  void end_block(std::size_t entry, std::size_t place);
  Triangle::CellList list() const;
  std::size_t bytes() const { return bytes_of(first) + bytes_of(blocks) + bytes_of(boxes); }
};

/// The primitives of cells, each kind apart.
struct CellStore : PerShape<ListStore, FiniteShapes> {
  std::uint64_t references = 0;

  CellLists lists() const;
  std::size_t bytes() const;
};

}  // namespace grelha
