#pragma once
// Which primitives of a cell overlap a frustum (SIMD over primitives). Each kind knows how to
// tell.

#include "kernel/traverse/frustum.hpp"

namespace grelha::GRELHA_ISA {

/// Bits of the boxes that overlap the frustum.
inline unsigned boxes_inside(const Frustum& f, const BlockBoxes& boxes) {
  unsigned inside = 0;
  for (int i = 0; i < kBlock; i += kWidth<Block>)
    inside |= f.inside_mask([&](int j) {
      return (Block(f.a[j]) * load<Block>(boxes.side[f.across[j]] + i) +
              Block(f.b[j]) * load<Block>(boxes.side[f.along[j]] + i)) +
             Block(f.c[j]);
    }) << i;
  unsigned ahead = 0;
  for (int i = 0; i < kBlock; i += kWidth<Block>)
    ahead |= bits(Block(f.to_slice) * load<Block>(boxes.side[f.last] + i) + Block(f.zero_slice) >=
                  Block(f.near))
             << i;
  return inside & ahead;
}

/// Groups of rays that may pass box k of a row.
[[gnu::always_inline]] inline std::uint64_t groups_near_box(const Frustum& f,
                                                            const BlockBoxes& boxes,
                                                            int k) {
  const float end = f.to_slice * boxes.side[f.last][k] + f.zero_slice;
  return f.groups_ahead(end) & f.groups_inside([&](int j, int first) {
    const VFloat slope = load<VFloat>(f.group_b[j] + first);
    const VFloat along =
        max(slope * VFloat(boxes.side[f.k][k]), slope * VFloat(boxes.side[f.k + 3][k]));
    return VFloat(f.a[j] * boxes.side[f.across[j]][k]) + along + load<VFloat>(f.group_c[j] + first);
  });
}

/// Bits of the rays from i on that pass box k of a row before their search ends.
[[gnu::always_inline]] inline unsigned rays_through(const Packet& p,
                                                    int i,
                                                    const BlockBoxes& boxes,
                                                    int k) {
  VFloat enter = load<VFloat>(p.t_min + i);
  VFloat leave = load<VFloat>(p.best + i);
  for (int a = 0; a < 3; ++a) {
    const float base = p.base ? p.base[a] : 0.f;
    const VFloat org = load<VFloat>(p.org[a] + i);
    clip_to_slab(VFloat(boxes.side[a][k] - base),
                 VFloat(boxes.side[a + 3][k] - base),
                 org,
                 load<VFloat>(p.inverse[a] + i),
                 enter,
                 leave);
  }
  return bits(enter <= leave);
}

/// Lanes of primitives i, i + 1, ... that come before `end`.
inline unsigned active_before(unsigned lanes, std::uint32_t i, std::uint32_t end) {
  return end - i < static_cast<unsigned>(kWidth<Block>) ? lanes & ((1u << (end - i)) - 1u) : lanes;
}

/// Calls visit(index in the list) for each primitive of a cell that overlaps the frustum.
template <class Fields, class Visit>
[[gnu::always_inline]] inline void each_inside(const Frustum& f,
                                               const CellArrays<Fields>& list,
                                               std::size_t cell,
                                               const Visit& visit) {
  const std::uint32_t end = list.first[cell + 1];
  for (std::uint32_t i = list.first[cell]; i < end; i += kWidth<Block>) {
    unsigned left = active_before(overlapping(f, list.fields, i), i, end);
    for (; left != 0; left &= left - 1)
      visit(i + static_cast<unsigned>(__builtin_ctz(left)));
  }
}

}  // namespace grelha::GRELHA_ISA
