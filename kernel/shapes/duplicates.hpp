#pragma once
// Exact copies of primitives: a ray that hits one hits all, so that the one with the lowest id is
// tested for them.

#include <cstdint>
#include <span>
#include <vector>

#include "kernel/shapes/shapes.hpp"
#include "kernel/shapes/primitives.hpp"

namespace grelha {

/// Finds, among some finite primitives (ids ascending), the copies of another one with a lower id:
/// the numbers that a test reads have the same bits. If two shapes have the same hash, a copy may
/// be missed.
std::vector<Copy> find_duplicates(const Primitives& p, std::span<const std::uint32_t> ids);

/// The planes behind the last one that is no copy.
std::vector<Copy> find_last_copies(const PlaneSpans& planes);

}  // namespace grelha
