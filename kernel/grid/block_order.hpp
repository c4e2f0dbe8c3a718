#pragma once
// Which triangles of a cell share a block.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernel/grid/grid.hpp"

namespace grelha {

/// Puts the triangles of a cell in an order in which each eight are neighbours, so that the boxes
/// of blocks are small.
///
/// Method  strips across the longest side of the bounds of the middles of the triangles' boxes,
///         clipped to the cell; blocks along the strips. Strips and blocks hold whole blocks.
/// Source  Leutenegger, Lopez, Edgington, "STR: A Simple and Efficient Algorithm for R-Tree
///         Packing", ICDE 1997.
class BlockOrder {
 public:
  /// The position of each triangle in a cell, a function of the cell and its triangles alone. The
  /// span lives until the next call.
  std::span<const std::uint32_t> places(const Primitives& p,
                                        std::span<const std::uint32_t> ids,
                                        const Grid& grid,
                                        std::size_t cell);

 private:
  /// The longest first.
  struct LongSides {
    std::array<int, 2> length;  ///< in parts
    std::array<std::size_t, 2> axis;
  };
  void find_parts(const Primitives& p,
                  std::span<const std::uint32_t> ids,
                  const Grid& grid,
                  std::size_t cell);
  LongSides long_sides() const;
  void order_strips(std::size_t size, std::size_t axis);

  /// which part of the cell, along each axis, the middle of a triangle's box is in
  std::vector<std::int16_t> part_[3];
  std::vector<std::int16_t> strip_;
  std::vector<std::uint32_t> places_, order_, ranks_;
};

}  // namespace grelha
