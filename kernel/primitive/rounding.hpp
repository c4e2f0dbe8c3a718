#pragma once
// Floats beside doubles, for bounds.

#include <bit>
#include <cstdint>

namespace grelha {

/// The greatest float not above a number; NaN for NaN. As not_above() of lanes, for those who
/// build.
inline float float_not_above(double x) {
  const float f = static_cast<float>(x);
  if (!(f > x))
    return f;
  const auto bits = std::bit_cast<std::int32_t>(f);
  return f == 0 ? -std::bit_cast<float>(1) : std::bit_cast<float>(f > 0 ? bits - 1 : bits + 1);
}
/// The least float not below a number.
inline float float_not_below(double x) {
  return -float_not_above(-x);
}

}  // namespace grelha
