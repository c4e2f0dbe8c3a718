#pragma once
// Lists of tiles, put together from what is seen of primitives: by depth, then by id.

#include <algorithm>
#include <bit>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "kernel/perspective/look_loops.hpp"
#include "kernel/scene/turns.hpp"

namespace grelha {

/// What the lists of one kind are made of.
template <class Seen>
struct ListSource {
  int kind;
  std::span<const Tile> tiles;
  std::span<const TileLists> lists;        ///< [tiles + 1] where each begins
  std::span<const std::uint32_t> numbers;  ///< of what is seen, list after list
  const SeenPages<Seen>& seen;
};

/// Writes the lists of tiles that threads take in turns.
template <class Seen, class Block>
class ListWriter {
 public:
  static constexpr std::size_t kTurn = 256;  ///< tiles

  ListWriter(const ListSource<Seen>& from, const LookLoops& loops, Block* to)
      : from_(from), loops_(loops), to_(to) {}

  void write(std::size_t turn) {
    const std::size_t end = std::min((turn + 1) * kTurn, from_.tiles.size());
    for (std::size_t t = turn * kTurn; t < end; ++t)
      write_list(from_.tiles[t], from_.lists[t].first[from_.kind], from_.lists[t + 1]);
  }

 private:
  /// What is seen comes from afar: it is asked for as many places early.
  static constexpr std::size_t kAhead = 24;

  /// With more, a sort takes less time than comparing each with each.
  static constexpr std::uint32_t kFew = 256;

  void write_list(const Tile& tile, std::uint32_t first, const TileLists& next) {
    const std::uint32_t count = next.first[from_.kind] - first;
    take(first, count);
    if (count <= kFew)
      loops_.rank(depths_.data(), ids_.data(), count, ranks_.data());
    else
      rank_many(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t at = first + ranks_[i];
      set_place(to_[at / kOutlines], at % kOutlines, from_.seen[from_.numbers[first + i]], tile);
    }
  }

  void take(std::uint32_t first, std::uint32_t count) {
    for (std::vector<std::uint32_t>* all : {&depths_, &ids_, &ranks_})
      if (all->size() < count + kRankRoom)
        all->resize(2 * count + kRankRoom);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::size_t ahead = std::min(first + i + kAhead, from_.numbers.size() - 1);
      __builtin_prefetch(&from_.seen[from_.numbers[ahead]]);
      const Seen& s = from_.seen[from_.numbers[first + i]];
      depths_[i] = ordered(s.near);
      ids_[i] = s.id;
    }
  }

  /// Floats as numbers in the same order.
  static std::uint32_t ordered(float x) {
    const auto bits = std::bit_cast<std::uint32_t>(x);
    return bits ^ (bits >> 31 ? 0xffffffffu : 0x80000000u);
  }

  void rank_many(std::uint32_t count) {
    order_.resize(count);
    std::iota(order_.begin(), order_.end(), 0u);
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(depths_[a], ids_[a]) < std::pair(depths_[b], ids_[b]);
    });
    for (std::uint32_t i = 0; i < count; ++i)
      ranks_[order_[i]] = i;
  }

  const ListSource<Seen>& from_;
  const LookLoops& loops_;
  Block* to_;
  // of one list
  std::vector<std::uint32_t> depths_, ids_, ranks_, order_;
};

template <class Seen, class Block>
void write_lists(const ListSource<Seen>& from, const LookLoops& loops, int threads, Block* to) {
  using Writer = ListWriter<Seen, Block>;
  if (from.numbers.empty())
    return;
  each_turn((from.tiles.size() + Writer::kTurn - 1) / Writer::kTurn,
            threads,
            [&] { return Writer(from, loops, to); },
            [](std::size_t turn, Writer& writer) { writer.write(turn); });
}

}  // namespace grelha
