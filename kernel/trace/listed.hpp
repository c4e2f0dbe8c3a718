#pragma once
// What the lists of a tile say of rays that look into it: which primitives they may meet, and which
// for sure. Many rays and a block, many rays and one primitive, one ray and a block.

#include "kernel/trace/point_lookup.hpp"

namespace grelha::GRELHA_ISA {

static_assert(kOutlines == kBlock);

/// A rectangle of places in a tile, and the depth of the farthest ray that looks through it.
struct TileWindow {
  float x0, x1, y0, y1, depth;
};

/// Lanes of a block that a window may show, and whether all of the block are near enough to.
struct ShownLanes {
  unsigned shown;
  bool all_near;
};

[[gnu::always_inline]] inline Mask<Block> shows(const TileWindow& w, const OutlineBlock& b, int i) {
  const auto side = [&](int s) {  // at the corner that is farthest inside
    const Block p = load<Block>(b.side[s][0] + i);
    const Block q = load<Block>(b.side[s][1] + i);
    const Block x = greater(p * Block(w.x0), p * Block(w.x1));
    const Block y = greater(q * Block(w.y0), q * Block(w.y1));
    return (x + y) + load<Block>(b.side[s][2] + i);
  };
  return lesser(lesser(side(0), side(1)), side(2)) >= Block(0);
}
[[gnu::always_inline]] inline Mask<Block> shows(const TileWindow& w, const BoxBlock& b, int i) {
  const Mask<Block> x =
      both(load<Block>(b.lo[0] + i) <= Block(w.x1), load<Block>(b.hi[0] + i) >= Block(w.x0));
  const Mask<Block> y =
      both(load<Block>(b.lo[1] + i) <= Block(w.y1), load<Block>(b.hi[1] + i) >= Block(w.y0));
  return both(x, y);
}

inline TileWindow window_around(const SearchPlaces& at,
                                const Mask<Lanes>& here,
                                const Lanes& depth) {
  const Lanes out(kInfinity), in(-kInfinity);
  return {
      lane_min(select(here, at.x, out)),
      lane_max(select(here, at.x, in)),
      lane_min(select(here, at.y, out)),
      lane_max(select(here, at.y, in)),
      lane_max(depth),
  };
}

/// Of places [first, end) of a list those in the block of `first`.
template <class Listed>
[[gnu::always_inline]] inline ShownLanes shown(const TileWindow& w,
                                               const Listed& b,
                                               std::uint32_t first,
                                               std::uint32_t end) {
  const unsigned lanes = blocks_between(first / kBlock * kBlock, first, end);
  unsigned in = 0;
  unsigned near = 0;
  for (int i = 0; i < kBlock; i += kWidth<Block>) {
    const Mask<Block> ahead = load<Block>(b.near + i) <= Block(w.depth);
    in |= bits(both(shows(w, b, i), ahead)) << i;
    near |= bits(ahead) << i;
  }
  return {in & lanes, (near & lanes) == lanes};
}

/// Lanes whose ray may meet a primitive, and those whose ray does for sure.
struct MetLanes {
  Mask<Lanes> maybe, surely;
};

/// The same of primitive k of a block, for rays that search up to `depth`.
[[gnu::always_inline]] inline MetLanes met_lanes(const SearchPlaces& at,
                                                 const Lanes& depth,
                                                 const OutlineBlock& b,
                                                 unsigned k) {
  const auto side = [&](int s) {
    return (Lanes(b.side[s][0][k]) * at.x + Lanes(b.side[s][1][k]) * at.y) + Lanes(b.side[s][2][k]);
  };
  const Lanes inside = lesser(lesser(side(0), side(1)), side(2));
  return {
      both(inside >= Lanes(0), Lanes(b.near[k]) <= depth),
      both(inside >= Lanes(kSurelyInside), Lanes(b.far[k]) <= depth),
  };
}
[[gnu::always_inline]] inline MetLanes met_lanes(const SearchPlaces& at,
                                                 const Lanes& depth,
                                                 const BoxBlock& b,
                                                 unsigned k) {
  const Mask<Lanes> met = both(both(at.x >= Lanes(b.lo[0][k]), at.x <= Lanes(b.hi[0][k])),
                               both(at.y >= Lanes(b.lo[1][k]), at.y <= Lanes(b.hi[1][k])));
  const Mask<Lanes> no = Lanes(0) != Lanes(0);
  return {both(met, Lanes(b.near[k]) <= depth), no};
}

/// A ray's place in a tile, and the depth of its start.
struct TilePlace {
  float x, y, depth;
};

/// Lanes of primitives that a ray may meet, those it does for sure, and those near enough to.
struct MetPrimitives {
  Mask<Block> maybe, surely, near;
};

/// The same of primitives i, i + 1, ... of a block.
[[gnu::always_inline]] inline MetPrimitives met_primitives(const TilePlace& at,
                                                           const OutlineBlock& b,
                                                           int i) {
  const Block x(at.x), y(at.y), depth(at.depth);
  const auto side = [&](int s) {
    return (load<Block>(b.side[s][0] + i) * x + load<Block>(b.side[s][1] + i) * y) +
           load<Block>(b.side[s][2] + i);
  };
  const Block inside = lesser(lesser(side(0), side(1)), side(2));
  const Mask<Block> near = load<Block>(b.near + i) <= depth;
  return {
      both(inside >= Block(0), near),
      both(inside >= Block(kSurelyInside), load<Block>(b.far + i) <= depth),
      near,
  };
}
[[gnu::always_inline]] inline MetPrimitives met_primitives(const TilePlace& at,
                                                           const BoxBlock& b,
                                                           int i) {
  const Block x(at.x), y(at.y), depth(at.depth);
  const Mask<Block> in_x = both(x >= load<Block>(b.lo[0] + i), x <= load<Block>(b.hi[0] + i));
  const Mask<Block> in_y = both(y >= load<Block>(b.lo[1] + i), y <= load<Block>(b.hi[1] + i));
  const Mask<Block> near = load<Block>(b.near + i) <= depth;
  return {both(both(in_x, in_y), near), depth != depth, near};
}

}  // namespace grelha::GRELHA_ISA
