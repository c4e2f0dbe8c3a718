#pragma once
// What walks through grids allow for rounding, and where they change their ways. u = 2^-24; the
// derivations are in docs/numerics.md ("What a frustum allows for"), which names the test that
// pins each.

namespace grelha {

/// Share of a ray's direction (sum of its components) that must lie along a packet's major axis:
/// rays cross at most 17/3 cells sideways a slice. With less a slice is wider than what rays
/// would walk alone, and nothing bounds the slopes (measured).
inline constexpr float kLeastProgress = .15f;

/// Slices below which a packet's stay in a grid has no slopes: dividing by it would make them of
/// rounding.
inline constexpr float kThinStay = 1e-3f;

/// Cells by which a frustum's bounds are widened beside what their own rounding asks for: a ball
/// may lie 24 u of the way beside a ray that its test in float meets. Covers ways of up to 45 cells
/// whatever the slopes; what is farther has kFrustumRounding, which grows with the way.
inline constexpr float kFrustumMargin = 1e-3f;

/// Times farthest place times steepest slope: what rounding takes of a frustum's bounds, 16.8 u.
/// What they are off by beyond that the pad of what a grid holds covers.
inline constexpr float kFrustumRounding = 1e-6f;

/// Times the farthest place: what a hit's t is off by, 46 u of its way, which is at most 2 sqrt 3
/// times the farthest: 9.5e-6.
inline constexpr float kNearSlack = 1.2e-5f;

/// Times the length of a plane's gradient, which is off by 2.5 u.
inline constexpr float kReachSlack = 1.00001f;

}  // namespace grelha
