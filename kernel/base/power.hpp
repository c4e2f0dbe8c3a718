#pragma once

#include "kernel/base/lanes.hpp"

namespace grelha::GRELHA_ISA {

/// log2 of positive normal numbers; relative error below 3e-7 (power_test.cpp), near 1 too,
/// where it matters for high exponents. libm's has other bits on other machines.
template <class Real>
inline Real log2_of(const Real& x) {
  using I = Int<Real>;
  const I raw = float_bits(x);
  // Move the mantissa into [sqrt(1/2), sqrt(2)): exponents count from there.
  const I biased = (raw - I(0x3F3504F3)) >> 23;
  const Real m = bits_float(I(raw - (biased << 23)));
  const Real f = (m - Real(1)) / (m + Real(1));
  const Real s = f * f;
  const Real series =
      Real(1) + s * (Real(1.f / 3) + s * (Real(1.f / 5) + s * (Real(1.f / 7) + s * Real(1.f / 9))));
  return to_float(biased) + (Real(2.88539008f) * f) * series;  // 2 / ln 2
}

/// 2^x for x in [-126, 127], clamped outside; relative error below 3e-7.
template <class Real>
inline Real exp2_of(const Real& x) {
  using I = Int<Real>;
  const Real z = max(min(x, Real(127)), Real(-126));
  const I n = to_int(z + select(z < Real(0), Real(-.5f), Real(.5f)));
  const Real r = (z - to_float(n)) * Real(0.69314718f);
  const Real e =
      Real(1) +
      r * (Real(1) + r * (Real(.5f) +
                          r * (Real(1.f / 6) + r * (Real(1.f / 24) +
                                                    r * (Real(1.f / 120) + r * Real(1.f / 720))))));
  return e * bits_float(I((n + I(127)) << 23));
}

/// x^y for x in [0, 2], y >= 0; 0^0 is 1.
template <class Real>
inline Real power(const Real& x, const Real& y) {
  const Real base = max(x, Real(1.2e-38f));
  return select(y == Real(0), Real(1), exp2_of<Real>(y * log2_of<Real>(base)));
}

}  // namespace grelha::GRELHA_ISA
