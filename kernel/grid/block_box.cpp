#include "kernel/grid/block_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grelha {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A little below, or above: what rounding to float (u of it) and the steps here (3 u) can come to,
/// and no more than 4 u beyond.
float not_above(double x) {
  const float f = static_cast<float>(x);
  return f - (std::abs(f) * 2.4e-7f + 1e-45f);
}
float not_below(double x) {
  const float f = static_cast<float>(x);
  return f + (std::abs(f) * 2.4e-7f + 1e-45f);
}

/// How far a block reaches along an axis; of an empty one, nowhere.
struct Reach {
  float lo = kInfinity;
  float hi = -kInfinity;
};
Reach reach_of(const TriangleBlock& block, int a) {
  float least[kBlock], most[kBlock];
  for (int i = 0; i < kBlock; ++i)
    least[i] = std::min(std::min(block.a[a][i], block.b[a][i]), block.c[a][i]);
  for (int i = 0; i < kBlock; ++i)
    most[i] = std::max(std::max(block.a[a][i], block.b[a][i]), block.c[a][i]);
  Reach r;
  for (int i = 0; i < kBlock; ++i) {
    // unused places are NaN and change neither
    r.lo = least[i] < r.lo ? least[i] : r.lo;
    r.hi = most[i] > r.hi ? most[i] : r.hi;
  }
  return r;
}

}  // namespace

// A hit h is off by no more than `pad` from its triangle, and found in a cell that it lies in. It
// is in the triangle's box grown by pad as well. So it is in the box below, and pad / 4 = 64 u
// diagonals inside it. A slab test in float is off by 3 u of the way to each plane, which is at
// most 2.8 diagonals (approach()). It compares two of them: 17 u diagonals.
void bound_blocks(const Grid& g,
                  double pad,
                  std::size_t cell,
                  std::uint32_t first,
                  std::uint32_t end,
                  ListStore<Triangle>& s) {
  const CellBox box = cell_box(g, cell);
  for (std::uint32_t b = first; b < end; ++b) {
    BlockBoxes& boxes = s.boxes[b / kBlock];
    for (int a = 0; a < 3; ++a) {
      const Reach r = reach_of(s.blocks[b], a);
      boxes.side[a][b % kBlock] = not_above(std::max(r.lo - pad, box.lo[a]) - pad / 4);
      boxes.side[3 + a][b % kBlock] = not_below(std::min(r.hi + pad, box.hi[a]) + pad / 4);
    }
  }
}

}  // namespace grelha
