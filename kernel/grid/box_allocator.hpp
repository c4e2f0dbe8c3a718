#pragma once
// Positions of the boxes of blocks in rows.

#include <cstdint>

#include "kernel/shapes/arrays.hpp"

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

}  // namespace grelha
