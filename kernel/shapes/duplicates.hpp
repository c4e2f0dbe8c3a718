#pragma once
// Exact copies of primitives: a ray that hits some hits the one with the lowest id, so that the
// others need not be tested.

#include <cstdint>
#include <span>
#include <vector>

#include "kernel/shapes/primitives.hpp"

namespace grelha {

/// Finds, among some finite primitives (ids ascending), the copies of another one with a lower id:
/// the numbers that a test reads have the same bits. If two shapes have the same hash, a copy may
/// be missed.
std::vector<std::uint32_t> find_duplicates(const Primitives& p, std::span<const std::uint32_t> ids);

/// Number of planes before the first copy: all planes behind these are copies.
std::uint32_t count_unique_planes(const PlaneSpans& planes);

}  // namespace grelha
