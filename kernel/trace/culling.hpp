#pragma once
// Which primitives reach into a frustum (SIMD over primitives), and for which groups of a packet
// (SIMD over groups).

#include "kernel/trace/frustum.hpp"

namespace grelha::GRELHA_ISA {

/// Bits of the groups for which `value(plane, first group)` is not negative for all four planes.
template <class Value>
inline std::uint64_t groups_inside(const Value& value) {
  std::uint64_t in = 0;
  const Lanes o(0);
  for (int i = 0; i < kGroups; i += kWidth<Lanes>) {
    const Mask<Lanes> out =
        either(either(value(0, i) < o, value(1, i) < o), either(value(2, i) < o, value(3, i) < o));
    in |= (~static_cast<std::uint64_t>(bits(out)) & ((std::uint64_t{1} << kWidth<Lanes>)-1)) << i;
  }
  return in;
}

/// Bits of the groups with a ray that has not passed slice s when it begins.
inline std::uint64_t groups_ahead(const Frustum& f, float s) {
  std::uint64_t in = 0;
  for (int i = 0; i < kGroups; i += kWidth<Lanes>)
    in |= (static_cast<std::uint64_t>(bits(load<Lanes>(f.group_near + i) <= Lanes(s))) &
           ((std::uint64_t{1} << kWidth<Lanes>)-1))
          << i;
  return in;
}

/// Bits of the lanes of a block for which `value(plane)` is not negative for all four planes of the
/// frustum.
template <class Value>
inline unsigned inside_planes(const Value& value) {
  const Block o(0);
  const Mask<Block> out =
      either(either(value(0) < o, value(1) < o), either(value(2) < o, value(3) < o));
  return ~bits(out) & ((1u << kWidth<Block>)-1u);
}

/// Bits of the boxes that reach into the frustum.
inline unsigned boxes_inside(const Frustum& f, const BlockBoxes& boxes) {
  unsigned inside = 0;
  for (int i = 0; i < kBlock; i += kWidth<Block>)
    inside |= inside_planes([&](int j) {
                return (Block(f.a[j]) * load<Block>(boxes.side[f.across[j]] + i) +
                        Block(f.b[j]) * load<Block>(boxes.side[f.along[j]] + i)) +
                       Block(f.c[j]);
              })
              << i;
  unsigned ahead = 0;
  for (int i = 0; i < kBlock; i += kWidth<Block>)
    ahead |= bits(Block(f.to_slice) * load<Block>(boxes.side[f.last] + i) + Block(f.zero_slice) >=
                  Block(f.near))
             << i;
  return inside & ahead;
}

/// Lanes of triangles i, i + 1, ... of a block that reach into the frustum.
[[gnu::noinline]] inline unsigned triangles_inside(const Frustum& f,
                                                   const TriangleBlock& block,
                                                   int i) {
  const Block au = load<Block>(block.a[f.u] + i);
  const Block av = load<Block>(block.a[f.v] + i);
  const Block ak = load<Block>(block.a[f.k] + i);
  const Block bu = load<Block>(block.b[f.u] + i);
  const Block bv = load<Block>(block.b[f.v] + i);
  const Block bk = load<Block>(block.b[f.k] + i);
  const Block cu = load<Block>(block.c[f.u] + i);
  const Block cv = load<Block>(block.c[f.v] + i);
  const Block ck = load<Block>(block.c[f.k] + i);
  const unsigned left = inside_planes([&](int j) {  // the corner farthest inside
    const Block s(f.a[j]);
    const Block r(f.b[j]);
    const Block fa = s * (j < 2 ? au : av) + r * ak;
    const Block fb = s * (j < 2 ? bu : bv) + r * bk;
    const Block fc = s * (j < 2 ? cu : cv) + r * ck;
    return greater(greater(fa, fb), fc) + Block(f.c[j]);
  });
  const Block s(f.to_slice);
  const Mask<Block> ahead =
      greater(greater(s * ak, s * bk), s * ck) + Block(f.zero_slice) >= Block(f.near);
  return left & bits(both(ahead, au == au));  // padding is NaN
}

/// Groups whose rays a triangle may meet.
inline std::uint64_t groups_near_triangle(const Frustum& f,
                                          const float (&a)[3],
                                          const float (&b)[3],
                                          const float (&c)[3]) {
  const float end =
      greater(greater(f.to_slice * a[f.k], f.to_slice * b[f.k]), f.to_slice * c[f.k]) +
      f.zero_slice;
  return groups_ahead(f, end) & groups_inside([&](int j, int first) {
           const int u = f.side(j);
           const Lanes s = load<Lanes>(f.group_b[j] + first);
           const Lanes fa = Lanes(f.a[j] * a[u]) + s * Lanes(a[f.k]);
           const Lanes fb = Lanes(f.a[j] * b[u]) + s * Lanes(b[f.k]);
           const Lanes fc = Lanes(f.a[j] * c[u]) + s * Lanes(c[f.k]);
           return greater(greater(fa, fb), fc) + load<Lanes>(f.group_c[j] + first);
         });
}

/// Of lanes of primitives i, i + 1, ... those before `end`.
inline unsigned lanes_before(unsigned lanes, std::uint32_t i, std::uint32_t end) {
  return end - i < static_cast<unsigned>(kWidth<Block>) ? lanes & ((1u << (end - i)) - 1u) : lanes;
}

/// Lanes of spheres i, i + 1, ... before `end` that reach into the frustum.
inline unsigned spheres_inside(const Frustum& f,
                               const CellLists& lists,
                               std::uint32_t i,
                               std::uint32_t end) {
  const float* const at[3] = {lists.sx, lists.sy, lists.sz};
  const Block u = load<Block>(at[f.u] + i);
  const Block v = load<Block>(at[f.v] + i);
  const Block k = load<Block>(at[f.k] + i);
  const Block r = magnitude(load<Block>(lists.sr + i));
  const unsigned left = inside_planes([&](int j) {
    return ((Block(f.a[j]) * (j < 2 ? u : v) + Block(f.b[j]) * k) + Block(f.c[j])) +
           r * Block(f.reach[j]);
  });
  return lanes_before(left, i, end);
}

/// Groups whose rays a sphere may meet.
inline std::uint64_t groups_near_sphere(const Frustum& f, const float (&center)[3], float radius) {
  return groups_inside([&](int j, int first) {
    const Lanes across =
        Lanes(f.a[j] * center[f.side(j)]) + load<Lanes>(f.group_b[j] + first) * Lanes(center[f.k]);
    return (across + load<Lanes>(f.group_c[j] + first)) +
           Lanes(radius) * load<Lanes>(f.group_reach[j] + first);
  });
}

/// Lanes of cones i, i + 1, ... before `end` that may reach into the frustum: a cone lies in the
/// hull of the balls around its two ends.
inline unsigned cones_inside(const Frustum& f,
                             const CellLists& lists,
                             std::uint32_t i,
                             std::uint32_t end) {
  const auto at = [&](int k) { return load<Block>(lists.cone[k] + i); };
  const Block h = at(6);
  const Block r0 = at(7);
  const Block r1 = r0 + at(8) * h;
  const Block u0 = at(f.u);
  const Block v0 = at(f.v);
  const Block k0 = at(f.k);
  const Block u1 = u0 + h * at(3 + f.u);
  const Block v1 = v0 + h * at(3 + f.v);
  const Block k1 = k0 + h * at(3 + f.k);
  const unsigned left = inside_planes([&](int j) {
    const Block s(f.a[j]);
    const Block q(f.b[j]);
    const Block reach(f.reach[j]);
    const Block base = (s * (j < 2 ? u0 : v0) + q * k0) + r0 * reach;
    const Block apex = (s * (j < 2 ? u1 : v1) + q * k1) + r1 * reach;
    return greater(base, apex) + Block(f.c[j]);
  });
  return lanes_before(left, i, end);
}

// ---- primitives of a block or a cell that reach into a frustum
// --------------------------------------------------------------------

/// Calls visit(place) for each triangle of a block.
template <class Visit>
[[gnu::always_inline]] inline void each_triangle_inside(const Frustum& f,
                                                        const TriangleBlock& block,
                                                        const Visit& visit) {
  for (int i = 0; i < kBlock; i += kWidth<Block>)
    for (unsigned left = triangles_inside(f, block, i); left != 0; left &= left - 1)
      visit(i + __builtin_ctz(left));
}

/// Calls visit(index in the lists) for each sphere of a cell.
template <class Visit>
[[gnu::always_inline]] inline void each_sphere_inside(const Frustum& f,
                                                      const CellLists& lists,
                                                      std::size_t cell,
                                                      const Visit& visit) {
  const std::uint32_t end = lists.sphere_first[cell + 1];
  for (std::uint32_t i = lists.sphere_first[cell]; i < end; i += kWidth<Block>)
    for (unsigned left = spheres_inside(f, lists, i, end); left != 0; left &= left - 1)
      visit(i + static_cast<unsigned>(__builtin_ctz(left)));
}

/// The same for cones.
template <class Visit>
[[gnu::always_inline]] inline void each_cone_inside(const Frustum& f,
                                                    const CellLists& lists,
                                                    std::size_t cell,
                                                    const Visit& visit) {
  const std::uint32_t end = lists.cone_first[cell + 1];
  for (std::uint32_t i = lists.cone_first[cell]; i < end; i += kWidth<Block>)
    for (unsigned left = cones_inside(f, lists, i, end); left != 0; left &= left - 1)
      visit(i + static_cast<unsigned>(__builtin_ctz(left)));
}

}  // namespace grelha::GRELHA_ISA
