#pragma once
// Where the search for what hides from samples draws its lines (beam.hpp,
// doubt.hpp). None of them decides what a picture shows where it is sampled;
// they decide where it is sampled on. Most are tastes that were measured, and
// say so; docs/numerics.md names the test that pins each.

namespace grelha {

/// Corner rays of a beam lie within this cosine of its axis, 3.6 degrees (taste: wider ones would
/// walk half the scene).
inline constexpr float kNarrow = .998f;

/// A beam whose half thickness is less, a unit along it, is none: places in it are off by 2.5 u
/// over that (measured). 8 u: pixels of a thousand rows have that where the picture is .05 degrees
/// high.
inline constexpr float kThinnest = 0x1p-21f;

/// Times the distance of a beam's rays from its middle: as far as an apex may lie. Rays that keep
/// apart have one there. Over a hundred widths of way they stray from its pyramid by less than a
/// hundredth, and what floats make of so far a place is off by less than that.
inline constexpr float kFarthestApex = 1e4f;
/// Share of the way between a beam's first origin and its last that is added: what the pyramid cuts
/// out of a mirror reaches beyond its corners by up to .08 of it, up to 84 degrees aslant
/// (measured). With less the mirror would be found in its own beam.
inline constexpr float kDepthMargin = .1f;

/// How near the rim a ball is aimed at, and how near its edge a beam is looked through: a ray that
/// must hit stays off what rounding decides. What reaches less than that into a beam is not found
/// in it (taste).
inline constexpr float kRimShare = .9f;

/// Times what a beam's corners meet, from its apex: how far the beam is looked at, and its grids
/// are walked. What lies as far as they meet counts as met. Rounding takes less than 10 u of the
/// way, of 1678.
inline constexpr float kBehindHit = 1.0001f;

/// Cosine of the widest angle, 37 degrees, at which two triangles pass for one
/// surface, and that the normals of one may turn within a beam (taste: beyond
/// it light is not smooth).
inline constexpr float kOneSurface = .8f;
inline constexpr float kOneSurfaceSquared = .64f;

/// The same of half that angle, squared: all triangles of a patch within it of one of them pass for
/// one surface with each other.
inline constexpr float kOnePatchSquared = (1 + kOneSurface) / 2;

/// An edge farther out than this share of a beam may have its other triangle
/// just outside.
inline constexpr float kEdgeInside = .95f;

/// A light's way ends before the surface it falls on: what is met within the
/// last 1e-4 is the surface itself, or what lies on it.
inline constexpr float kBeforeSurface = .9999f;

/// Mirrors that weigh less are not followed. A choice, not measured: a sixty-fourth of white is
/// four steps of a picture of 8 bits.
inline constexpr float kLeastMirror = 1.f / 64;

/// Clear surfaces that a beam is followed through: two panes of glass have four (a choice).
inline constexpr int kClearsFollowed = 4;

/// In places of a beam: what a box of things found is grown by, and the share of its size. Light
/// that comes by way of a bent surface leaves the pixel a little beside its place in the beam (a
/// choice: what lies outside is sampled all the same, only less often).
inline constexpr float kBoxRoom = .02f;
inline constexpr float kBoxGrowth = .1f;

/// A beam is this much wider than its pixel, lest it doubts what its neighbours
/// see, or than a square of pixels that is to be left out as a whole: what only
/// touches an edge counts as well.
inline constexpr float kPixelGrowth = 1.0625f;
inline constexpr float kSquareGrowth = 1.25f;

}  // namespace grelha
