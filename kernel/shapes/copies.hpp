#pragma once
// Exact copies of primitives: whatever a ray meets of them it meets of the one with the lowest id,
// so that the others need not be tested.

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "kernel/shapes/primitives.hpp"

namespace grelha {

/// The numbers that a test of a primitive sees, at most ten, by their bits.
struct Shape {
  std::uint32_t bits[10] = {};
  bool operator==(const Shape&) const = default;
  void set(std::size_t at, float value) { bits[at] = std::bit_cast<std::uint32_t>(value); }
  /// FNV-1a over words.
  std::uint64_t hash() const {
    std::uint64_t h = 0xCBF29CE484222325u;
    for (const std::uint32_t b : bits)
      h = (h ^ b) * 0x100000001B3u;
    return h ^ h >> 32;
  }
};

/// Of a finite primitive.
Shape shape_of(const Primitives& p, std::uint32_t id);

/// Those of some primitives (ids ascending) that are copies of another of them with a lower id.
/// Where two shapes have one hash, a copy may be missed.
std::vector<std::uint32_t> copies_among(const Primitives& p, std::span<const std::uint32_t> ids);

/// So many of the first planes are all there are: those behind are copies.
std::uint32_t planes_without_copies(const PlaneSpans& planes);

}  // namespace grelha
