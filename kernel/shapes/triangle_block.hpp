#pragma once
// Triangles side by side, as lists of cells hold them.

#include <cstdint>

#include "kernel/shapes/arrays.hpp"

namespace grelha {

/// Eight triangles side by side; unused positions hold NaN corners, which no ray can hit.
struct alignas(64) TriangleBlock {
  float a[3][kBlock], b[3][kBlock], c[3][kBlock];
  std::uint32_t id[kBlock];
};

/// A row of boxes, for up to eight blocks that follow each other: each holds the part of a block's
/// triangles within its cell, and is grown. A ray that hits a triangle there passes through the
/// box. The box of an unused position ends before it begins, so no ray passes through it. Position
/// p is box p % kBlock of row p / kBlock; box_allocator.hpp says which block has which.
struct alignas(64) BlockBoxes {
  float side[6][kBlock];  ///< least x, y, z, greatest x, y, z
};

}  // namespace grelha
