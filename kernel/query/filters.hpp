#pragma once
// Elements of a caller's stream, and the primitives that its rays leave out.

#include "grelha/query.hpp"

namespace grelha {

/// Throws std::invalid_argument if an array without a default is null.
void expect_arrays(const Rays& rays);
/// Throws std::invalid_argument if there are masks, but not one for each primitive.
void expect_masks(const World& world, std::span<const std::uint8_t> masks);

/// Ray i of a stream.
Ray ray_of(const Rays& rays, std::size_t i);
/// Rays [first, end) of a stream.
Rays part_of(const Rays& rays, std::size_t first, std::size_t end);
/// Answers of the rays from `first` on.
Hits part_of(const Hits& hits, std::size_t first);
/// What ray i of a stream leaves out.
inline Filter filter_of(const Rays& rays, const QueryOptions& options, std::size_t i) {
  return {rays.skip ? rays.skip[i] : kNoPrimitive,
          options.mask,
          rays.mask ? rays.mask[i] : std::uint8_t{255}};
}

}  // namespace grelha
