#pragma once
// Floats beside doubles, for bounds.

#include <bit>
#include <cstdint>

namespace grelha {

/// The greatest float not above a number; NaN for NaN. As round_down() of lanes, for those who
/// build.
inline float float_not_above(double x) {
  const float f = static_cast<float>(x);
  // As whole numbers in the order of floats, one less: nothing foretells which way x was rounded.
  const auto in_order = [](std::int32_t bits) { return bits ^ (bits >> 31 & INT32_MAX); };
  const std::int32_t below = in_order(std::bit_cast<std::int32_t>(f)) - (f > x ? 1 : 0);
  return std::bit_cast<float>(in_order(below));
}
/// The least float not below a number.
inline float float_not_below(double x) {
  return -float_not_above(-x);
}

}  // namespace grelha
