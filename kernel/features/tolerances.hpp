#pragma once
// Where the search for what hides from samples draws its lines (beam.hpp,
// doubt.hpp). None of them decides what a picture shows where it is sampled;
// they decide where it is sampled on. Most are tastes that were measured, and
// say so; docs/numerics.md names the test that pins each.

namespace grelha {

/// Corner rays of a beam lie within this cosine of its axis: wider ones would
/// walk half the scene.
inline constexpr float kNarrow = .998f;

/// Rays apart by offset whose directions spread by less than this share of it
/// have no apex near them: one 1 / kLeastGrowth offsets away stands for it.
inline constexpr float kLeastGrowth = 1e-4f;
inline constexpr float kFarthestApex = 1e4f;
/// Share of the way between a beam's first origin and its last that is added,
/// for rounding.
inline constexpr float kDepthMargin = .1f;

/// How near the rim a ball is aimed at, and how far off its edge a triangle: a
/// ray that must hit stays off what rounding decides.
inline constexpr float kRimShare = .9f;
inline constexpr float kOffEdge = .01f;
/// 1 - cos^2 below which a cone's axis runs along the beam's: the place nearest
/// to it is rounding.
inline constexpr float kParallelAxes = 1e-6f;

/// A hit's place along the beam is off by rounding; what lies this much farther
/// counts as met.
inline constexpr float kBehindHit = 1.0001f;
/// The same of the frustum's end, whose rays are the pyramid's edges.
inline constexpr float kBehindBeam = 1.001f;

/// Cosine of the widest angle, 37 degrees, at which two triangles pass for one
/// surface, and that the normals of one may turn within a beam (taste: beyond
/// it light is not smooth).
inline constexpr float kOneSurface = .8f;
inline constexpr float kOneSurfaceSquared = .64f;

/// An edge farther out than this share of a beam may have its other triangle
/// just outside.
inline constexpr float kEdgeInside = .95f;

/// A light's way ends before the surface it falls on: what is met within the
/// last 1e-4 is the surface itself, or what lies on it.
inline constexpr float kBeforeSurface = .9999f;

/// Mirrors that weigh less are not followed. A choice, not measured: a sixty-fourth of white is
/// four steps of a picture of 8 bits.
inline constexpr float kLeastMirror = 1.f / 64;

/// A beam is this much wider than its pixel, lest it doubts what its neighbours
/// see, or than a square of pixels that is to be left out as a whole: what only
/// touches an edge counts as well.
inline constexpr float kPixelGrowth = 1.0625f;
inline constexpr float kSquareGrowth = 1.25f;

}  // namespace grelha
