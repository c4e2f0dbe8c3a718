#pragma once
// The volume that the rays of a packet go through in a grid: four planes
// around them, slice by slice along their major axis. After Wald, Ize, Kensler, Knoll, Parker, "Ray
// Tracing Animated Scenes using Coherent Grid Traversal", SIGGRAPH 2006.

#include "kernel/traverse/stream_traversal.hpp"

namespace grelha::GRELHA_ISA {

inline constexpr int kGroups = kPacket / kWidth<VFloat>;
inline constexpr int kGroupRow = kGroups > kWidth<VFloat> ? kGroups : kWidth<VFloat>;

/// rays of the packets that larger ones fall apart into
inline constexpr int kSmall = 16;
inline constexpr int kMiddle = 64;

enum class Coherence {
  kMisses,     ///< no ray hits the grid
  kTogether,   ///< one frustum holds them
  kIncoherent  ///< they do not all make headway along one axis
};

/// In the grid's cells: K is the major axis (flipped when the rays run against it, so slices always
/// ascend), U and V the others. Between slices `from` and `to` every ray stays between lo and hi,
/// straight lines in s: a chord lies below the concave least of straight lines, and above the
/// convex greatest.
struct Frustum {
  int k, u, v;
  bool flip;
  /// of cells to what lies before them in the octant of all rays, or, where they have none in
  /// common, in any direction
  const std::uint8_t* distance;
  float from, to;
  float lo[2], lo_slope[2], hi[2], hi_slope[2];  ///< at s = from, and per slice
  float margin;                                  ///< rounding of all of these, in cells
  float steepest;                                ///< greatest |slope|, at least 1
  alignas(64) float position[kPacket];           ///< of each ray's origin along K
  alignas(64) float per_slice[kPacket];          ///< t a slice takes
  /// t at which the ray leaves the grid; -infinity: never hits it
  alignas(64) float leave[kPacket];
  /// Four planes f(x) = a xu + b xk + c, negative outside, for culling; gradient_length = length
  /// of the gradient.
  float a[4], b[4], c[4], gradient_length[4];
  /// The same planes for each group of a large packet alone; the a are those above. A group without
  /// a ray here has c = -infinity.
  bool by_group;
  alignas(64) float group_b[4][kGroupRow], group_c[4][kGroupRow],
      group_gradient_length[4][kGroupRow];
  int across[4], along[4];  ///< which of a box's sides are farthest inside each
  /// s = to_slice x + zero_slice along K; nothing that ends before `near` is hit, or of a group
  /// before `group_near`.
  float to_slice, zero_slice, near;
  int last;  ///< which of a box's sides is farthest along
  alignas(64) float group_near[kGroupRow];

  /// The axis of the grid across which planes 0, 1 (u) and 2, 3 (v) stand.
  int side(int plane) const { return plane < 2 ? u : v; }

  /// Bits of the lanes of a block for which `value(plane)` is not negative for all four planes.
  template <class Value>
  unsigned inside_mask(const Value& value) const {
    const Block o(0);
    const Mask<Block> out =
        mask_or(mask_or(value(0) < o, value(1) < o), mask_or(value(2) < o, value(3) < o));
    return ~bits(out) & ((1u << kWidth<Block>)-1u);
  }

  /// Bits of the groups for which `value(plane, first group)` is not negative for all four planes.
  template <class Value>
  std::uint64_t groups_inside(const Value& value) const {
    std::uint64_t in = 0;
    const VFloat o(0);
    for (int i = 0; i < kGroups; i += kWidth<VFloat>) {
      const Mask<VFloat> out = mask_or(mask_or(value(0, i) < o, value(1, i) < o),
                                       mask_or(value(2, i) < o, value(3, i) < o));
      in |= (~static_cast<std::uint64_t>(bits(out)) & ((std::uint64_t{1} << kWidth<VFloat>)-1))
            << i;
    }
    return in;
  }

  /// Bits of the groups with a ray that has not passed slice s when it begins.
  std::uint64_t groups_ahead(float s) const {
    std::uint64_t in = 0;
    for (int i = 0; i < kGroups; i += kWidth<VFloat>)
      in |= (static_cast<std::uint64_t>(bits(load<VFloat>(group_near + i) <= VFloat(s))) &
             ((std::uint64_t{1} << kWidth<VFloat>)-1))
            << i;
    return in;
  }
};

}  // namespace grelha::GRELHA_ISA
