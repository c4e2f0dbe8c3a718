#pragma once
// Ids of primitives as ranges.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grelha {

/// Ids that follow each other.
struct IdRange {
  std::uint32_t first = 0, end = 0;
  bool operator==(const IdRange&) const = default;
};

/// Ascending ids as ranges, or none if they are too scattered.
inline std::vector<IdRange> ranges_of(std::span<const std::uint32_t> ids) {
  constexpr std::size_t kMostRanges = 1024;
  std::vector<IdRange> ranges;
  for (std::size_t i = 0; i < ids.size();) {
    if (ranges.size() == kMostRanges)
      return {};
    const std::uint32_t first = ids[i];
    while (++i < ids.size() && ids[i] == ids[i - 1] + 1)
      ;
    ranges.push_back({first, ids[i - 1] + 1});
  }
  return ranges;
}

inline bool overlap(std::span<const IdRange> some, std::span<const IdRange> others) {
  for (const IdRange& one : some)
    for (const IdRange& other : others)
      if (one.first < other.end && other.first < one.end)
        return true;
  return false;
}

}  // namespace grelha
