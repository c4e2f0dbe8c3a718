#pragma once
// The order in which items in space are put under the nodes of a packed tree.

#include <algorithm>
#include <cstdint>
#include <span>

#include "kernel/shapes/arrays.hpp"

namespace grelha {

/// Puts items in the order of a tree of eight children a node: splits them across their longest
/// side into two parts of whole nodes, then each part. An item has a place `at`, three numbers, and
/// an `id` that decides between equal ones.
class PackedOrder {
 public:
  /// `unit`: the length of 1 of `at` along each axis.
  explicit PackedOrder(const double (&unit)[3]) : unit_{unit[0], unit[1], unit[2]} {}

  template <class Item>
  void sort(std::span<Item> items) const {
    std::size_t node = 1;
    while (node < items.size())
      node *= kBlock;
    sort(items, node);
  }

 private:
  /// `node`: the most items of a node of the level below, 8^k; recursion is as deep as the number
  /// of items has bits.
  template <class Item>
  void sort(std::span<Item> items, std::size_t node) const {
    while (node >= items.size() && node > 1)
      node /= kBlock;
    if (items.size() <= kBlock && node == 1)
      return;
    const int across = longest_side(std::span<const Item>(items));
    const std::size_t nodes = (items.size() + node - 1) / node;
    const std::size_t middle = nodes / 2 * node;
    const auto before = [across](const Item& a, const Item& b) {
      return a.at[across] != b.at[across] ? a.at[across] < b.at[across] : a.id < b.id;
    };
    std::nth_element(
        items.begin(), items.begin() + static_cast<std::ptrdiff_t>(middle), items.end(), before);
    sort(items.first(middle), node);
    sort(items.subspan(middle), node);
  }

  template <class Item>
  int longest_side(std::span<const Item> items) const {
    Item lo = items[0], hi = items[0];
    for (const Item& item : items)
      for (int a = 0; a < 3; ++a) {
        lo.at[a] = std::min(lo.at[a], item.at[a]);
        hi.at[a] = std::max(hi.at[a], item.at[a]);
      }
    const auto length = [&](int a) { return static_cast<double>(hi.at[a] - lo.at[a]) * unit_[a]; };
    int longest = 0;
    for (int a = 1; a < 3; ++a)
      if (length(a) > length(longest))
        longest = a;
    return longest;
  }

  const double unit_[3];
};

}  // namespace grelha
