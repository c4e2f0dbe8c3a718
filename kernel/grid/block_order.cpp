#include "kernel/grid/grid_steps.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace grelha {
namespace {

constexpr std::size_t kFew = 128;
constexpr int kCellParts = 256;  ///< of a cell, along each axis: kFew kCellParts = 2^15

/// rank() of many, by sorting.
void rank_many(std::span<const std::int16_t> values, std::uint32_t* ranks) {
  std::vector<std::uint64_t> keys(values.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    keys[i] = static_cast<std::uint64_t>(values[i]) << 32 | i;
  std::sort(keys.begin(), keys.end());
  for (std::size_t i = 0; i < keys.size(); ++i)
    ranks[static_cast<std::uint32_t>(keys[i])] = static_cast<std::uint32_t>(i);
}

/// rank() of at most kFew: counting those before each is fastest.
void rank_few(std::span<const std::int16_t> values, std::uint32_t* ranks) {
  constexpr std::size_t kRow = 8;
  const std::size_t count = values.size();
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

/// How many of `values`, and of the equal ones those before, come before each.
void rank(std::span<const std::int16_t> values, std::uint32_t* ranks) {
  if (values.size() > kFew)
    rank_many(values, ranks);
  else
    rank_few(values, ranks);
}

/// A cell along one axis, in parts.
struct CellParts {
  CellParts(const Grid& grid, const CellBox& box, std::size_t a)
      : lo(static_cast<float>(box.lo[a])),
        hi(static_cast<float>(box.hi[a])),
        half(static_cast<float>(kCellParts / (2 * grid.cell[a]))) {}

  /// Part that holds the middle of the extent of three corners, clipped to the cell; 0 for NaN.
  std::int16_t of_middle(float a, float b, float c) const {
    const float least = std::max(lo, std::min(std::min(a, b), c));
    const float most = std::min(hi, std::max(std::max(a, b), c));
    const float in = ((least - lo) + (most - lo)) * half;
    return static_cast<std::int16_t>(std::min(std::max(0.f, in), kCellParts - 1.f));
  }

  float lo, hi;
  float half;  ///< parts a length, halved
};

}  // namespace

void BlockOrder::find_parts(const Primitives& p,
                            std::span<const std::uint32_t> ids,
                            const Grid& grid,
                            std::size_t cell) {
  const CellBox box = cell_box(grid, cell);
  const CellParts parts[3] = {{grid, box, 0}, {grid, box, 1}, {grid, box, 2}};
  const TriangleSpans& t = p.geometry.triangles;
  const std::uint32_t first_id = p.ids.begin(PrimitiveKind::kTriangle);
  const Floats* const of[3] = {&t.x, &t.y, &t.z};
  for (auto& part : part_)
    part.resize(ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::uint32_t j = ids[i] - first_id;
    const std::uint32_t v[3] = {t.a[j], t.b[j], t.c[j]};
    for (std::size_t a = 0; a < 3; ++a) {
      const Floats& x = *of[a];
      part_[a][i] = parts[a].of_middle(x[v[0]], x[v[1]], x[v[2]]);
    }
  }
}

/// The two axes along which the middles are farthest apart.
BlockOrder::LongSides BlockOrder::long_sides() const {
  std::pair<int, std::size_t> extents[3];
  for (std::size_t a = 0; a < 3; ++a) {
    std::int16_t lo = kCellParts;
    std::int16_t hi = 0;
    for (const std::int16_t x : part_[a]) {
      lo = std::min(lo, x);
      hi = std::max(hi, x);
    }
    extents[a] = {lo - hi, a};
  }
  std::sort(std::begin(extents), std::end(extents));
  return {{-extents[0].first, -extents[1].first}, {extents[0].second, extents[1].second}};
}

/// Along each strip of `size` triangles, which stand in the order of places_, orders them by their
/// parts along an axis.
void BlockOrder::order_strips(std::size_t size, std::size_t axis) {
  const std::size_t count = places_.size();
  order_.resize(count);
  strip_.resize(count);
  ranks_.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    order_[places_[i]] = static_cast<std::uint32_t>(i);
  for (std::size_t i = 0; i < count; ++i)
    strip_[i] = part_[axis][order_[i]];
  for (std::size_t from = 0; from < count; from += size) {
    const std::size_t n = std::min(size, count - from);
    rank({strip_.data() + from, n}, ranks_.data());
    for (std::size_t i = 0; i < n; ++i)
      places_[order_[from + i]] = static_cast<std::uint32_t>(from) + ranks_[i];
  }
}

std::span<const std::uint32_t> BlockOrder::places(const Primitives& p,
                                                  std::span<const std::uint32_t> ids,
                                                  const Grid& grid,
                                                  std::size_t cell) {
  const std::size_t blocks = (ids.size() + kBlock - 1) / kBlock;
  places_.resize(ids.size());
  if (blocks == 1) {
    std::iota(places_.begin(), places_.end(), 0u);
    return places_;
  }
  find_parts(p, ids, grid, cell);
  const auto [length, axis] = long_sides();
  rank(part_[axis[0]], places_.data());
  const long most = static_cast<long>(blocks) * length[0];
  std::size_t strips = 1;  // as many as make blocks square
  while (strips < blocks && static_cast<long>(strips * strips) * std::max(1, length[1]) < most)
    ++strips;
  if (strips < blocks)
    order_strips((blocks + strips - 1) / strips * kBlock, axis[1]);
  return places_;
}

}  // namespace grelha
