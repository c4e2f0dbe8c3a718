#pragma once
// Streams of a caller: their elements and options, checked, and shared among threads.

#include <algorithm>
#include <functional>

#include "grelha/query.hpp"
#include "kernel/query/variants.hpp"

namespace grelha {

/// Throws std::invalid_argument if an array without a default is null.
void expect_arrays(const Rays& rays);
/// Throws std::invalid_argument if there are masks, but not one for each primitive.
void expect_masks(const World& world, std::span<const std::uint8_t> masks);

/// Answers of the rays from `first` on.
Hits part_of(const Hits& hits, std::size_t first);
/// What ray i of a stream leaves out.
inline Filter filter_of(const Rays& rays, const QueryOptions& options, std::size_t i) {
  return {rays.skip ? rays.skip[i] : kNoPrimitive,
          options.mask,
          rays.mask ? rays.mask[i] : std::uint8_t{255}};
}

/// Throws std::invalid_argument for a packet of another size than 1, 16, 64 or 256.
TraceOptions options_of(const QueryOptions& options);

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
