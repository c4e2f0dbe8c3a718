#pragma once
// What the lists of point grids allow for; docs/perspective.md derives it.

namespace grelha {

/// What look-ups in double round by, in u and v: 16 ulps of the largest, 1.
inline constexpr double kLookUp = 0x1p-48;
/// What places within a tile round by, in tiles: floats of at most 1, and a product.
inline constexpr double kPlaceRounding = 0x1p-22;
/// Of the coefficients of a side: what floats round by when it is evaluated, 8 u.
inline constexpr double kSideRounding = 0x1p-21;
/// Times that, for each tile between where a side is told from and where it is evaluated, 16 u.
inline constexpr double kSpanRounding = 2;
/// Nearer primitives, in pads, have no outline: every ray meets them.
inline constexpr double kNearest = 8;
/// What rays may miss primitives by, in pads of the object grids, and how far they stray from the
/// point: where only rays that start near the scene are looked up, and where they are brought near.
inline constexpr double kNearPads = 1;
inline constexpr double kNearAside = 1. / 16;
inline constexpr double kFarPads = 2;
inline constexpr double kFarAside = 1;
/// Margins that a corner lies at least inside of the side across from it, where rays may meet a
/// triangle for sure.
inline constexpr double kSolid = 4;
/// Directions beyond the edge of a face that count as its own: look-ups round.
inline constexpr double kOverlap = 0x1p-30;
/// Margins are this much wider than derived, for the rounding of doubles.
inline constexpr double kRoom = 1 + 0x1p-20;
/// Sides that are seen under a narrower angle are left out: doubles could not tell on which side of
/// them a primitive lies.
inline constexpr double kNarrowest = 1e-6;

}  // namespace grelha
