#pragma once
// Bounds of rounding in walks through grids, and thresholds between ways to walk. u = 2^-24; the
// derivations are in docs/numerics.md ("What a frustum allows for"), which names the test that pins
// each.

namespace grelha {

/// Times the largest component of a direction: least size of the others. Over a scene a ray strays
/// by as much of it, where floats stray by 1e-7.
inline constexpr float kMinAdvance = 1e-12f;

/// Share of a ray's direction (sum of its components) that must lie along a packet's major axis:
/// rays cross at most 17/3 cells sideways a slice. With less a slice is wider than what rays
/// would walk alone, and nothing bounds the slopes (measured).
inline constexpr float kLeastProgress = .15f;

/// Slices below which a packet's stay in a grid has no slopes: dividing by it would make them of
/// rounding.
inline constexpr float kThinStay = 1e-3f;

/// Times farthest position times steepest slope: error of the sides of a frustum, 38 u.
inline constexpr float kSideRounding = 2.3e-6f;

/// Times the farthest position from 0 times steepest slope: further error of planes in world
/// coordinates, 14 u.
inline constexpr float kPlaneRounding = 1e-6f;

/// Times a grid's pad: how far beside a ray of the frustum a ball or a cone may lie that its float
/// test finds hit. That is 127 u of the scene's diagonal; half a pad is 128.
inline constexpr float kPadOfBalls = .5f;

/// Times the farthest position: how far a hit may lie before its ray's start, 46 u of the way along
/// the major axis, which is at most twice the farthest: 92 u.
inline constexpr float kNearSlack = 6e-6f;

/// Times the end of a way through a box, wherever the ray starts: t of its planes are off by 3 u of
/// themselves each, 6 u of 16.8 u.
inline constexpr float kOutsideSlack = 1.000001f;
/// Added to the same: more than t of two planes lose to underflow, 2^-149 each.
inline constexpr float kOutsideUnderflow = 0x1p-140f;

/// Times the length of a plane's gradient, which is off by 2.5 u.
inline constexpr float kGradientTolerance = 1.00001f;

}  // namespace grelha
