#pragma once
// Shares the elements of a query among threads.

#include <algorithm>
#include <functional>

#include "grelha/query.hpp"

namespace grelha {

/// Elements that a thread takes at once. It looks whether to stop after each, once a millisecond.
struct RunLengths {
  std::size_t first, most;
};
inline constexpr RunLengths kRays{64, 1024};  ///< whole packets
inline constexpr RunLengths kPoints{1, 64};   ///< some take 1 us, and the next may take 50 ms

/// Calls work(first, end) for runs of elements that together are [0, count), on options.threads
/// threads. Throws Stopped once options.progress returns false, and the first exception of work().
void each_run(std::size_t count,
              const QueryOptions& options,
              const std::function<void(std::size_t first, std::size_t end)>& work,
              RunLengths lengths = kRays);

/// Throws std::invalid_argument if there is not one answer for each of the `things`.
void expect_same_size(std::size_t count, std::size_t answers, const char* things);

}  // namespace grelha
