#include "kernel/grid/grid_steps.hpp"

#include <algorithm>
#include <limits>

#include "kernel/shapes/rounding.hpp"

namespace grelha {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Boxes reach kSlabPadding * pad beyond the error of hits. A slab test in float is off by
/// 3 u of the distance to each plane, which is at most 2.8 near distances of the grid, and compares
/// two such values: 17 u near distances. A quarter of a pad is 64 u.
constexpr double kSlabPadding = .25;

/// Extent of a block along an axis; empty if the block is.
struct BlockExtent {
  float lo = kInfinity;
  float hi = -kInfinity;
};
BlockExtent block_extent(const TriangleBlock& block, int a) {
  float least[kBlock], most[kBlock];
  for (int i = 0; i < kBlock; ++i)
    least[i] = std::min(std::min(block.a[a][i], block.b[a][i]), block.c[a][i]);
  for (int i = 0; i < kBlock; ++i)
    most[i] = std::max(std::max(block.a[a][i], block.b[a][i]), block.c[a][i]);
  BlockExtent r;
  for (int i = 0; i < kBlock; ++i) {
    // unused positions are NaN and change neither
    r.lo = least[i] < r.lo ? least[i] : r.lo;
    r.hi = most[i] > r.hi ? most[i] : r.hi;
  }
  return r;
}

}  // namespace

void set_bounds(const TriangleBlock& block, BlockBoxes& row, std::size_t at) {
  for (int a = 0; a < 3; ++a) {
    const BlockExtent r = block_extent(block, a);
    row.side[a][at] = r.lo;
    row.side[3 + a][at] = r.hi;
  }
}

std::uint64_t write_boxes(std::size_t begin,
                          std::size_t end,
                          std::uint64_t row,
                          std::uint64_t block,
                          ListStore<Triangle>& s) {
  BoxAllocator allocator(row);
  for (std::size_t c = begin; c < end; ++c) {
    const std::uint32_t blocks = s.first[c];
    const std::uint64_t free = allocator.next();
    const std::uint64_t place = allocator.take(blocks);
    if (place != free)
      s.end_row(free);
    for (std::uint64_t r = (place + kBlock - 1) / kBlock; r < allocator.rows(); ++r)
      s.first_block[r] = static_cast<std::uint32_t>(block + r * kBlock - place);
    s.first[c] = static_cast<std::uint32_t>(place);
    block += blocks;
  }
  s.end_row(allocator.next());
  return allocator.rows();
}

// A hit h is off by no more than `pad` from its triangle, and found in a cell that it lies in. It
// is in the triangle's box grown by pad as well. So it is in the box below, kSlabPadding inside it.
void bound_blocks(
    const Grid& g, double pad, std::size_t cell, std::uint32_t triangles, ListStore<Triangle>& s) {
  const CellBox box = cell_box(g, cell);
  const double padding = kSlabPadding * pad;
  const std::uint32_t first = s.first[cell];
  const std::uint32_t block = s.list().blocks_of(cell).first;
  for (std::uint32_t b = 0; b < s.entries_of(triangles); ++b) {
    BlockBoxes& boxes = s.boxes[(first + b) / kBlock];
    const std::uint32_t at = (first + b) % kBlock;
    for (int a = 0; a < 3; ++a) {
      const BlockExtent r = block_extent(s.blocks[block + b], a);
      boxes.side[a][at] = float_not_above(std::max(r.lo - pad, box.lo[a]) - padding);
      boxes.side[3 + a][at] = float_not_below(std::min(r.hi + pad, box.hi[a]) + padding);
    }
  }
}

}  // namespace grelha
