#pragma once

namespace grelha {

struct SineCosine {
  double sine, cosine;
};

/// Sine and cosine of an angle within a quarter turn, in radians, by their series summed from the
/// smallest term. They are the same bits on every machine, which those of libm are not.
inline SineCosine sine_cosine(double x) {
  const double xx = x * x;
  double s = 1;
  double c = 1;
  for (int k = 12; k >= 1; --k) {
    s = 1 - s * xx / ((2 * k) * (2 * k + 1));
    c = 1 - c * xx / ((2 * k) * (2 * k - 1));
  }
  return {s * x, c};
}

}  // namespace grelha
