#pragma once
// Where rays that go to a point look in its grid (kernel/perspective/).

#include "kernel/perspective/view.hpp"
#include "kernel/walk/packet.hpp"

namespace grelha::GRELHA_ISA {

/// Where the rays of a group look.
struct SearchPlaces {
  Lanes x, y;   ///< within the tile, 0 to 1
  Lanes depth;  ///< of where the rays start; not below
  Lanes tile;   ///< its number, or kNoTile
};
inline constexpr float kNoTile = -1;

/// Added and taken away again, these leave the nearest whole number.
inline constexpr double kToWhole = 0x1.8p52;
inline constexpr float kToWholeFloat = 0x1.8p23f;

/// The same of a part of the group, in double.
template <class D>
struct WidePlaces {
  D x, y, depth, tile;
};

/// Directions from the point as faces see them: p / r, q / r, r and the face's number.
template <class D>
struct FaceDirections {
  D u, v, depth, face;
};

template <class D>
inline FaceDirections<D> face_directions(const Vec3<D>& d) {
  const D x = magnitude(d.x);
  const D y = magnitude(d.y);
  const D z = magnitude(d.z);
  const Mask<D> on_x = both(x >= y, x >= z);
  const Mask<D> on_y = y >= z;
  const D r = select(on_x, d.x, select(on_y, d.y, d.z));
  const D p = select(on_x, d.y, select(on_y, d.z, d.x));
  const D q = select(on_x, d.z, select(on_y, d.x, d.y));
  const D depth = magnitude(r);
  const D inverse = D(1) / depth;
  const D axis = select(on_x, D(0), select(on_y, D(2), D(4)));
  return {
      p * inverse,
      q * inverse,
      depth,
      axis + select(r < D(0), D(1), D(0)),
  };
}

/// Which of n parts holds x, or the one beside it where x lies on the border.
template <class D>
inline D part_of(const D& x, const D& n, const D& to_whole) {
  const D nearest = ((x - D(.5f)) + to_whole) - to_whole;
  return lesser(greater(nearest, D(0)), n - D(1));
}

/// The tile of those lanes whose direction goes through face f.
template <class D>
inline void look_through(const PointFace& f,
                         const FaceDirections<D>& d,
                         const Mask<D>& here,
                         WidePlaces<D>& to) {
  const D u = (d.u - D(f.u)) * D(f.per_u);
  const D v = (d.v - D(f.v)) * D(f.per_v);
  const D nx(f.nx), ny(f.ny), o(0);
  // not where there are no tiles
  const Mask<D> seen = both(both(u >= o, u < nx), both(v >= o, v < ny));
  const D column = part_of(u, nx, D(kToWhole));
  const D row = part_of(v, ny, D(kToWhole));
  to.tile = select(here, D(f.first) + select(seen, row * nx + column, nx * ny), to.tile);
  to.x = select(here, select(seen, u - column, o), to.x);
  to.y = select(here, select(seen, v - row, o), to.y);
  to.depth = select(here, d.depth - D(f.depth), to.depth);
}

template <class D>
inline WidePlaces<D> wide_places(const PointGridView& g, const Vec3<D>& org) {
  const FaceDirections<D> d =
      face_directions<D>({org.x - D(g.point[0]), org.y - D(g.point[1]), org.z - D(g.point[2])});
  double face[kWidth<D>];
  store(face, d.face);
  WidePlaces<D> to{D(0), D(0), D(0), D(0)};
  for (unsigned left = (1u << kWidth<D>)-1; left != 0;) {
    const double number = face[__builtin_ctz(left)];
    const Mask<D> here = d.face == D(number);
    left &= ~bits(here);
    look_through(g.face[static_cast<int>(number)], d, here, to);
  }
  return to;
}

template <int part = 0>
[[gnu::always_inline]] inline void look_up_parts(const PointGridView& g,
                                                 const Vec3<Lanes>& org,
                                                 Wide<Lanes> (&to)[4][kWideParts<Lanes>]) {
  using D = Wide<Lanes>;
  const WidePlaces<D> at =
      wide_places<D>(g, {widen<part>(org.x), widen<part>(org.y), widen<part>(org.z)});
  to[0][part] = at.x;
  to[1][part] = at.y;
  to[2][part] = at.depth;
  to[3][part] = at.tile;
  if constexpr (part + 1 < kWideParts<Lanes>)
    look_up_parts<part + 1>(g, org, to);
}

/// Tiles of rays that start at `org`; kNoTile where they search no more.
[[gnu::noinline]] inline SearchPlaces look_up(const PointGridView& g,
                                              const Vec3<Lanes>& org,
                                              const Mask<Lanes>& searches) {
  Wide<Lanes> to[4][kWideParts<Lanes>];
  look_up_parts(g, org, to);
  // more than what rounding takes away
  const Lanes depth = greater(narrow<Lanes>(to[2]), Lanes(0)) * Lanes(1 + 0x1p-22f);
  const Lanes tile = select(searches, narrow<Lanes>(to[3]), Lanes(kNoTile));
  return {
      narrow<Lanes>(to[0]),
      narrow<Lanes>(to[1]),
      depth,
      tile,
  };
}

/// Places in the parts of a tile, of lanes that look into it.
inline SearchPlaces look_closer(const SearchPlaces& at, const Mask<Lanes>& here, float columns) {
  const Lanes n(columns), x = at.x * n, y = at.y * n;
  const Lanes column = part_of(x, n, Lanes(kToWholeFloat));
  const Lanes row = part_of(y, n, Lanes(kToWholeFloat));
  const Lanes tile = select(here, row * n + column, Lanes(kNoTile));
  return {
      x - column,
      y - row,
      at.depth,
      tile,
  };
}

/// Calls visit(tile, lanes) for each tile that lanes look into.
template <class Visit>
[[gnu::always_inline]] inline void each_tile(const Lanes& tile, const Visit& visit) {
  alignas(64) float number[kWidth<Lanes>];
  store(number, tile);
  for (unsigned left = bits(tile >= Lanes(0)); left != 0;) {
    const float one = number[__builtin_ctz(left)];
    const Mask<Lanes> here = tile == Lanes(one);
    left &= ~bits(here);
    visit(static_cast<std::uint32_t>(one), here);
  }
}

}  // namespace grelha::GRELHA_ISA
