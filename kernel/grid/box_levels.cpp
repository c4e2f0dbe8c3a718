#include "kernel/grid/box_levels.hpp"

#include <algorithm>

namespace grelha {

std::vector<std::uint32_t> level_starts(std::size_t cells) {
  std::vector<std::uint32_t> first{0};
  for (std::size_t n = cells; n > 0; n = n > kBlock ? rows_of(n) : 0)
    first.push_back(first.back() + static_cast<std::uint32_t>(rows_of(n)));
  return first;
}

BoxLevelsView BoxLevels::view() const {
  BoxLevelsView v;
  v.rows = rows.data();
  v.cells = cells.data();
  v.levels = static_cast<int>(first.size());
  std::copy(first.begin(), first.end(), v.first);
  return v;
}

std::size_t box_level_bytes(std::size_t cells) {
  const std::vector<std::uint32_t> first = level_starts(cells);
  return first.back() * sizeof(BlockBoxes) + (cells + first.size() - 1) * sizeof(std::uint32_t);
}

}  // namespace grelha
