#pragma once
// Steps of building a grid: pairs of cells and primitives, blocks of triangles and their boxes,
// levels of boxes.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "kernel/shapes/arrays.hpp"
#include "kernel/grid/grid.hpp"
#include "kernel/base/raw_vector.hpp"

namespace grelha {

/// Assigns positions in rows of boxes, cell after cell. A cell's boxes are in no more rows than
/// they fill: otherwise most cells would lie across two rows, and rays would read both. If the rest
/// of a row is too short, the cell begins the next row, and those positions stay empty.
class BoxAllocator {
 public:
  /// From a row on.
  explicit BoxAllocator(std::uint64_t row) : next_(row * kBlock) {}

  /// Returns where the boxes of a cell with `blocks` blocks begin; for 0 blocks, where the last
  /// end.
  std::uint64_t take(std::uint32_t blocks) {
    if (blocks != 0 && next_ % kBlock + blocks > rows_of(blocks) * kBlock)
      next_ = rows() * kBlock;
    const std::uint64_t place = next_;
    next_ += blocks;
    return place;
  }
  std::uint64_t next() const { return next_; }
  /// Number of rows up to next(), including one that is partly filled.
  std::uint64_t rows() const { return rows_of(next_); }

 private:
  static std::uint64_t rows_of(std::uint64_t boxes) { return (boxes + kBlock - 1) / kBlock; }

  std::uint64_t next_;
};

// Boxes of blocks of triangles.

/// Replaces the numbers of blocks in cells [begin, end) by the positions where their boxes begin,
/// from `row` on, whose first box is that of `block`. Returns the row behind the last.
std::uint64_t write_boxes(std::size_t begin,
                          std::size_t end,
                          std::uint64_t row,
                          std::uint64_t block,
                          ListStore<Triangle>& store);

/// Computes a box for each block of the triangles of one cell: their bounds within the cell. Bounds
/// and cell are grown by `pad`, as when triangles are given to cells, and the box by a quarter more
/// for the rounding of its slab test.
void bound_blocks(const Grid& grid,
                  double pad,
                  std::size_t cell,
                  std::uint32_t triangles,
                  ListStore<Triangle>& store);

/// Sets box `at` of a row to the bounds of a block.
void set_bounds(const TriangleBlock& block, BlockBoxes& row, std::size_t at);

// Which triangles of a cell share a block.

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

// Which primitive stands in which cell: pairs, sorted by bucket, a run of neighbouring cells.

constexpr std::size_t kMostBuckets = 256;
constexpr unsigned kLeastShift = 8;  ///< a bucket has at least 2^8 cells

struct Pair {
  std::uint32_t cell, id;
};

struct PairChunk {
  RawVector<Pair> pairs;             ///< by bucket; within one as they came
  std::vector<std::uint32_t> first;  ///< [buckets + 1]
};

/// Runs of 2^shift cells each, the last perhaps shorter.
struct Buckets {
  std::size_t cells, count;
  unsigned shift = kLeastShift;

  explicit Buckets(std::size_t all) : cells(all) {
    while (((cells - 1) >> shift) >= kMostBuckets)
      ++shift;
    count = ((cells - 1) >> shift) + 1;
  }
  std::size_t begin(std::size_t bucket) const { return bucket << shift; }
  std::size_t end(std::size_t bucket) const { return std::min((bucket + 1) << shift, cells); }
};

/// Puts the pairs of a chunk in the order of their buckets. `first` holds how many each has, and
/// then where they begin.
inline void sort_pairs(const std::vector<Pair>& pairs, unsigned shift, PairChunk& chunk) {
  std::vector<std::uint32_t>& first = chunk.first;
  std::uint32_t sum = 0;
  for (std::uint32_t& f : first)
    sum += std::exchange(f, sum);
  chunk.pairs.resize(pairs.size());
  for (const Pair& pair : pairs)
    chunk.pairs[first[pair.cell >> shift]++] = pair;
  std::copy_backward(first.begin(), first.end() - 1, first.end());
  first[0] = 0;
}

// Builds the levels of boxes over a grid's cells.

/// Builds the levels of a grid whose lists and distances are there. The box of a cell bounds those
/// of its blocks of triangles, or is the cell, grown by the grid's pad, where it holds others.
BoxLevels build_box_levels(const Grid& grid);

}  // namespace grelha
