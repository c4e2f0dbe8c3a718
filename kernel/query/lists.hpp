#pragma once
// What many rays find, one after another in one array.

#include <vector>

#include "kernel/query/runs.hpp"

namespace grelha {

/// Calls find(i) for each i below count, on options.threads threads, and puts what it returns, a
/// vector, one after another; offset[i]: where that of i begins, [count + 1].
template <class Item, class Find>
void list_each(std::size_t count,
               const QueryOptions& options,
               std::vector<std::size_t>& offset,
               std::vector<Item>& items,
               const Find& find) {
  std::vector<std::vector<Item>> found(count);
  each_run(count, options, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i)
      found[i] = find(i);
  });
  offset.reserve(count + 1);
  offset.push_back(0);
  for (const std::vector<Item>& some : found)
    offset.push_back(offset.back() + some.size());
  items.reserve(offset.back());
  for (const std::vector<Item>& some : found)
    items.insert(items.end(), some.begin(), some.end());
}

}  // namespace grelha
