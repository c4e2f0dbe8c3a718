#pragma once
// Triangles side by side, as lists of cells hold them.

#include <cstdint>

#include "kernel/primitive/arrays.hpp"

namespace grelha {

/// Eight triangles side by side; unused places hold NaN corners, which no ray can meet.
struct alignas(64) TriangleBlock {
  float a[3][kBlock], b[3][kBlock], c[3][kBlock];
  std::uint32_t id[kBlock];
};

/// A row of boxes, of up to eight blocks that follow each other: of each, what of its triangles
/// lies in its cell, boxed and grown. A ray that meets one of them there passes through. No ray
/// passes through a box of no block, which ends before it begins. Place p is box p % kBlock of row
/// p / kBlock; box_places.hpp says which block has which.
struct alignas(64) BlockBoxes {
  float side[6][kBlock];  ///< least x, y, z, greatest x, y, z
};

}  // namespace grelha
