#pragma once
// What the lists of point grids allow for; docs/perspective.md derives it.

namespace grelha {

/// What places within a tile round by, in tiles: 2^-36 of look-ups in double, floats of at most 1,
/// and a product for each level of parts.
inline constexpr double kPlaceRounding = 0x1p-22;
/// Of the coefficients of a side: what floats round by when it is evaluated, 8 u.
inline constexpr double kOutlineRounding = 0x1p-21;
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
/// Times the lengths of its factors: what a normal is off by in doubles, along a direction whose
/// largest component is 1.
inline constexpr double kNormalRounding = 0x1p-49;
/// Squared sine of the angle that a cone is seen under: thinner ones have no sides, of whose
/// normals rounding would leave too little.
inline constexpr double kNarrowestCone = 1e-6;

}  // namespace grelha
