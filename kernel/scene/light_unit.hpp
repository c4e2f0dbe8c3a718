#pragma once
// How sums of light are counted.

namespace grelha {

/// Sums of light are integers in units of 2^-32, so that they come out the same in whatever order
/// terms arrive.
inline constexpr double kLightUnit = 4294967296.0;
/// Terms are clamped to kMostLight divided by the samples a pixel, and to kMostTerm: then 64 of the
/// largest a sample still fit.
inline constexpr float kMostLight = 33554432.f;
inline constexpr float kMostTerm = 1048576.f;

}  // namespace grelha
