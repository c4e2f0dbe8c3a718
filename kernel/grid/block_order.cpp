#include "kernel/grid/block_order.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace grelha {
namespace {

constexpr std::size_t kFew = 128;
constexpr int kCellParts = 256;  ///< of a cell, along each axis: kFew kCellParts = 2^15

/// How many of `values`, and of the equal ones those before, come before each. Of few, counting
/// them is fastest.
void rank(std::span<const std::int16_t> values, std::uint32_t* ranks) {
  const std::size_t count = values.size();
  if (count > kFew) {
    std::vector<std::uint64_t> keys(count);
    for (std::size_t i = 0; i < count; ++i)
      keys[i] = static_cast<std::uint64_t>(values[i]) << 32 | i;
    std::sort(keys.begin(), keys.end());
    for (std::size_t i = 0; i < count; ++i)
      ranks[static_cast<std::uint32_t>(keys[i])] = static_cast<std::uint32_t>(i);
    return;
  }
  constexpr std::size_t kRow = 8;
  std::int16_t keys[kFew] = {};
  for (std::size_t i = 0; i < count; ++i)
    keys[i] = static_cast<std::int16_t>(static_cast<std::size_t>(values[i]) * kFew + i);
  for (std::size_t i = 0; i < count; i += kRow) {
    std::int16_t below[kRow] = {};
    for (std::size_t j = 0; j < count; ++j)
      for (std::size_t k = 0; k < kRow; ++k)
        below[k] = static_cast<std::int16_t>(below[k] + (keys[j] < keys[i + k]));
    for (std::size_t k = 0; k < kRow && i + k < count; ++k)
      ranks[i + k] = static_cast<std::uint32_t>(below[k]);
  }
}

}  // namespace

void BlockOrder::find_parts(const Primitives& p,
                            std::span<const std::uint32_t> ids,
                            const Grid& grid,
                            std::size_t cell) {
  const std::size_t nx = grid.cells[0], ny = grid.cells[1],
                    at[3] = {cell % nx, cell / nx % ny, cell / nx / ny};
  const TriangleSpans& t = p.geometry.triangles;
  const std::uint32_t first_id = p.ids.begin(PrimitiveKind::kTriangle);
  const Floats* const of[3] = {&t.x, &t.y, &t.z};
  float half[3], lo[3], hi[3];
  for (std::size_t a = 0; a < 3; ++a) {
    half[a] = static_cast<float>(kCellParts / (2 * grid.cell[a]));
    lo[a] = static_cast<float>(grid.lo[a] + static_cast<double>(at[a]) * grid.cell[a]);
    hi[a] = static_cast<float>(grid.lo[a] + static_cast<double>(at[a] + 1) * grid.cell[a]);
    part_[a].resize(ids.size());
  }
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::uint32_t j = ids[i] - first_id, v[3] = {t.a[j], t.b[j], t.c[j]};
    for (std::size_t a = 0; a < 3; ++a) {
      const float x[3] = {(*of[a])[v[0]], (*of[a])[v[1]], (*of[a])[v[2]]};
      const float least = std::max(lo[a], std::min(std::min(x[0], x[1]), x[2])),
                  most = std::min(hi[a], std::max(std::max(x[0], x[1]), x[2]));
      const float in = ((least - lo[a]) + (most - lo[a])) * half[a];
      // NaN: 0
      part_[a][i] = static_cast<std::int16_t>(std::min(std::max(0.f, in), kCellParts - 1.f));
    }
  }
}

std::span<const std::uint32_t> BlockOrder::places(const Primitives& p,
                                                  std::span<const std::uint32_t> ids,
                                                  const Grid& grid,
                                                  std::size_t cell) {
  const std::size_t count = ids.size(), blocks = (count + kBlock - 1) / kBlock;
  places_.resize(count);
  if (blocks == 1) {
    std::iota(places_.begin(), places_.end(), 0u);
    return places_;
  }
  find_parts(p, ids, grid, cell);
  std::pair<int, std::size_t> extents[3];
  for (std::size_t a = 0; a < 3; ++a) {
    std::int16_t lo = kCellParts, hi = 0;
    for (const std::int16_t x : part_[a]) {
      lo = std::min(lo, x);
      hi = std::max(hi, x);
    }
    extents[a] = {lo - hi, a};
  }
  std::sort(std::begin(extents), std::end(extents));
  const auto& [longest, first] = extents[0];
  const auto& [longer, second] = extents[1];
  rank(part_[first], places_.data());
  std::size_t strips = 1;  // as many as make blocks square
  while (strips < blocks && static_cast<long>(strips * strips) * std::max(1, -longer) <
                                static_cast<long>(blocks) * -longest)
    ++strips;
  if (strips == blocks)
    return places_;
  const std::size_t size = (blocks + strips - 1) / strips * kBlock;
  order_.resize(count);
  strip_.resize(count);
  ranks_.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    order_[places_[i]] = static_cast<std::uint32_t>(i);
  for (std::size_t i = 0; i < count; ++i)
    strip_[i] = part_[second][order_[i]];
  for (std::size_t from = 0; from < count; from += size) {
    const std::size_t n = std::min(size, count - from);
    rank({strip_.data() + from, n}, ranks_.data());
    for (std::size_t i = 0; i < n; ++i)
      places_[order_[from + i]] = static_cast<std::uint32_t>(from) + ranks_[i];
  }
  return places_;
}

}  // namespace grelha
