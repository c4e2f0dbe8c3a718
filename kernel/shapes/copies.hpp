#pragma once
// Exact copies of primitives that stand in no cell: their originals stand there for them.

#include <cstdint>

namespace grelha {

/// A primitive and one of its copies, which has a higher id.
struct Copy {
  std::uint32_t original, copy;
  friend auto operator<=>(const Copy&, const Copy&) = default;
};

/// Copies in order of their originals, then of their ids. Inlined, or the linker could take another
/// file's.
struct CopyTable {
  const Copy* pair = nullptr;
  std::uint32_t count = 0;

  /// The first pair of an original, if it has() one; others follow.
  [[gnu::always_inline]] std::uint32_t begin(std::uint32_t id) const {
    std::uint32_t first = 0;
    for (std::uint32_t left = count; left > 0;) {
      const std::uint32_t half = left / 2;
      const bool is_less = pair[first + half].original < id;
      first = is_less ? first + half + 1 : first;
      left = is_less ? left - half - 1 : half;
    }
    return first;
  }
  [[gnu::always_inline]] bool has(std::uint32_t i, std::uint32_t id) const {
    return i < count && pair[i].original == id;
  }
};

}  // namespace grelha
