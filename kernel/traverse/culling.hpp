#pragma once
// Which primitives of a cell overlap a frustum (SIMD over primitives). Each kind knows how to
// tell.

#include "kernel/traverse/frustum.hpp"

namespace grelha::GRELHA_ISA {

/// Bits of the boxes that overlap the frustum.
inline unsigned boxes_inside(const Frustum& f, const BlockBoxes& boxes) {
  unsigned inside = 0;
  for (int i = 0; i < kBlock; i += kWidth<Block>)
    inside |= f.inside_mask([&](int j) {
      return (Block(f.a[j]) * load<Block>(boxes.side[f.across[j]] + i) +
              Block(f.b[j]) * load<Block>(boxes.side[f.along[j]] + i)) +
             Block(f.c[j]);
    }) << i;
  unsigned ahead = 0;
  for (int i = 0; i < kBlock; i += kWidth<Block>)
    ahead |= bits(Block(f.to_slice) * load<Block>(boxes.side[f.last] + i) + Block(f.zero_slice) >=
                  Block(f.near))
             << i;
  return inside & ahead;
}

/// Lanes of primitives i, i + 1, ... that come before `end`.
inline unsigned active_before(unsigned lanes, std::uint32_t i, std::uint32_t end) {
  return end - i < static_cast<unsigned>(kWidth<Block>) ? lanes & ((1u << (end - i)) - 1u) : lanes;
}

/// Calls visit(index in the block) for each primitive of a block that overlaps the frustum.
template <class BlockOf, class Visit>
[[gnu::always_inline]] inline void each_inside_block(const Frustum& f,
                                                     const BlockOf& block,
                                                     const Visit& visit) {
  for (int i = 0; i < kBlock; i += kWidth<Block>)
    for (unsigned left = overlapping(f, block, i); left != 0; left &= left - 1)
      visit(i + __builtin_ctz(left));
}

/// Calls visit(index in the list) for each primitive of a cell that overlaps the frustum.
template <class Fields, class Visit>
[[gnu::always_inline]] inline void each_inside(const Frustum& f,
                                               const CellArrays<Fields>& list,
                                               std::size_t cell,
                                               const Visit& visit) {
  const std::uint32_t end = list.first[cell + 1];
  for (std::uint32_t i = list.first[cell]; i < end; i += kWidth<Block>) {
    unsigned left = active_before(overlapping(f, list.fields, i), i, end);
    for (; left != 0; left &= left - 1)
      visit(i + static_cast<unsigned>(__builtin_ctz(left)));
  }
}

}  // namespace grelha::GRELHA_ISA
