#pragma once
// Exact copies of primitives: whatever a ray meets of them it meets of the one with the lowest id,
// so that the others need not be tested.

#include <cstdint>
#include <span>
#include <vector>

#include "kernel/shapes/primitives.hpp"

namespace grelha {

/// Those of some finite primitives (ids ascending) that are copies of another of them with a lower
/// id: the numbers that a test sees have the same bits. Where two shapes have one hash, a copy may
/// be missed.
std::vector<std::uint32_t> copies_among(const Primitives& p, std::span<const std::uint32_t> ids);

/// So many of the first planes are all there are: those behind are copies.
std::uint32_t planes_without_copies(const PlaneSpans& planes);

}  // namespace grelha
