#pragma once
// Where boxes of blocks stand.

#include <cstdint>

#include "kernel/primitive/arrays.hpp"

namespace grelha {

/// Deals out places in rows of boxes, cell after cell. A cell's boxes are in no more rows than they
/// fill: else most cells would lie across two, and rays look into both. Where what is left of a row
/// does not do, the cell begins the next one, and those places stay empty.
class BoxPlaces {
 public:
  /// From a row on.
  explicit BoxPlaces(std::uint64_t row) : next_(row * kBlock) {}

  /// Where the boxes of a cell of so many blocks begin; of one of none, where those before it end.
  std::uint64_t take(std::uint32_t blocks) {
    if (blocks != 0 && next_ % kBlock + blocks > rows_of(blocks) * kBlock)
      next_ = rows() * kBlock;
    const std::uint64_t place = next_;
    next_ += blocks;
    return place;
  }
  std::uint64_t next() const { return next_; }
  /// Those until here, what is left of the last among them.
  std::uint64_t rows() const { return rows_of(next_); }

 private:
  static std::uint64_t rows_of(std::uint64_t boxes) { return (boxes + kBlock - 1) / kBlock; }

  std::uint64_t next_;
};

}  // namespace grelha
