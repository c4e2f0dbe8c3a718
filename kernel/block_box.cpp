#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/grid.hpp"

namespace grelha {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float not_above(double x) {
  const float f = static_cast<float>(x);
  return f > x ? std::nextafter(f, -kInfinity) : f;
}
float not_below(double x) {
  const float f = static_cast<float>(x);
  return f < x ? std::nextafter(f, kInfinity) : f;
}

}  // namespace

// A hit h, off by no more than `pad` from its triangle, is found in the cell whose part of the ray h lies on: h is in that cell and in
// the triangle's box grown by pad, so in the box below, and pad / 4 = 64 u diagonals inside it. A slab test in float is off by
// 3 u of the way to each plane, which is at most 2.8 diagonals (approach()), and compares two of them: 17 u diagonals.
RawVector<BlockBoxes> bound_blocks(const Grid& g, double pad, int threads) {
  const CellStore& s = g.store;
  RawVector<BlockBoxes> out;
  out.resize((s.triangles.size() + kBlock - 1) / kBlock);
  const int nx = static_cast<int>(g.cells[0]), ny = static_cast<int>(g.cells[1]), nz = static_cast<int>(g.cells[2]);
  if (out.empty()) return out;
  for (auto& side : out.back().side) std::fill(std::begin(side), std::end(side), kInfinity);  // places without a block
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) {
        const std::size_t cell = static_cast<std::size_t>(x) + g.cells[0] * (static_cast<std::size_t>(y) + g.cells[1] * static_cast<std::size_t>(z));
        const int at[3] = {x, y, z};
        for (std::uint32_t b = s.triangle_first[cell]; b < s.triangle_first[cell + 1]; ++b) {
          const TriangleBlock& block = s.triangles[b];
          for (int a = 0; a < 3; ++a) {
            float lo = kInfinity, hi = -kInfinity;
            for (int i = 0; i < kBlock; ++i)  // unused places are NaN and change neither
              for (const float v : {block.a[a][i], block.b[a][i], block.c[a][i]}) lo = v < lo ? v : lo, hi = v > hi ? v : hi;
            const double cell_lo = g.lo[a] + at[a] * g.cell[a], cell_hi = g.lo[a] + (at[a] + 1) * g.cell[a];
            out[b / kBlock].side[a][b % kBlock] = not_above(std::max(lo - pad, cell_lo) - pad / 4);
            out[b / kBlock].side[3 + a][b % kBlock] = not_below(std::min(hi + pad, cell_hi) + pad / 4);
          }
        }
      }
  return out;
}

}  // namespace grelha
