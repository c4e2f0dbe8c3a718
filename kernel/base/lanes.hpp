#pragma once
// The numbers that hot loops compute with. Every hot header is compiled once per instruction set,
// inside a namespace of that set's name (GRELHA_ISA), so that no function of one copy can be linked
// into another. The files lanes_*.hpp alone name xsimd and intrinsics.
//
// VFloat           one float per SIMD lane, as wide as the machine's registers: one ray a lane
// Block            the same, at most 8 wide: one primitive of a block a lane
// float            the scalar twin; every function exists for it too, with the same bits
// VDouble, double  the same in double precision, half as many lanes
// Words<VFloat>    unsigned 32-bit integers beside them; Words<float> is one. + - * ^ & | << >>,
//                  == and ?: are written as for one
//
// Only + - * / sqrt, comparisons and selects: these give the same bits at every width. No
// reciprocal, no rsqrt, no fused multiply-add, no unary minus (it loses -0 on AVX-512).
//
// and_not(a, b) is a and not b, lane by lane; bit i of bits(m) is lane i.

#include <cstdint>

#include "kernel/base/isa.hpp"
#include "kernel/base/lanes_four.hpp"

#if GRELHA_ISA_NUMBER == 1
#include "kernel/base/lanes_scalar.hpp"
namespace grelha::GRELHA_ISA {
using VFloat = float;
using Block = float;
using VDouble = double;
}  // namespace grelha::GRELHA_ISA
#else
#include "kernel/base/lanes_simd.hpp"
#endif

namespace grelha::GRELHA_ISA {

/// The greater magnitude of two; of a NaN it is not the same on every instruction set.
template <class Real>
inline Real max_abs(const Real& a, const Real& b) {
  return max(magnitude(a), magnitude(b));
}

/// Calls visit(i) for each bit i, the lowest first.
template <class Visit>
[[gnu::always_inline]] inline void each_bit(unsigned bits, const Visit& visit) {
  for (; bits != 0; bits &= bits - 1)
    visit(__builtin_ctz(bits));
}

/// Lanes to be stored one behind another. A store may write as much as all lanes would take.
class CompressMask {
 public:
  explicit CompressMask(unsigned lanes) : lanes_(lanes) {}
  int count() const { return __builtin_popcount(lanes_); }
  /// T: float or std::uint32_t, from VFloat or its Words.
  template <class T, class Vector>
  [[gnu::always_inline]] void store(T* to, const Vector& a) const {
    compress_store(to, a, lanes_);
  }
  /// The same of three components, from element `at` of their arrays on.
  template <class Arrays, class Vector>
  [[gnu::always_inline]] void store(Arrays& to, int at, const Vector& a) const {
    store(to.x + at, a.x);
    store(to.y + at, a.y);
    store(to.z + at, a.z);
  }

 private:
  unsigned lanes_;
};

template <class Real>
using Scalar = typename LaneTraits<Real>::Scalar;
template <class Real>
using Mask = typename LaneTraits<Real>::Mask;
template <class Real>
using Int = typename LaneTraits<Real>::Int;
template <class Real>
using Words = typename LaneTraits<Real>::Words;
template <class Real>
inline constexpr int kWidth = LaneTraits<Real>::kWidth;
using VMask = Mask<VFloat>;
using VUint = Words<VFloat>;
inline constexpr int kSimdWidth = kWidth<VFloat>;

template <class Real>
inline Real load(const Scalar<Real>* p) {
  Real r;
  load(p, r);
  return r;
}
template <class Real>
inline Words<Real> load_words(const std::uint32_t* p) {
  Words<Real> r;
  __builtin_memcpy(&r, p, sizeof r);
  return r;
}
/// Bits of the lanes where words compare so.
template <class Compared>
inline unsigned bits_where(const Compared& c) {
  return bits(mask_of(VUint(c)));
}
template <class Word>
inline void store_words(std::uint32_t* p, const Word& a) {
  __builtin_memcpy(p, &a, sizeof a);
}
/// first, first + 1, ... one a lane.
template <class Real>
inline Words<Real> counted_words(std::uint32_t first) {
  static constexpr std::uint32_t kCount[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  return load_words<Real>(kCount) + first;
}

/// Floats as they are, or widened.
template <class Real>
inline Real take(const float* p) {
  if constexpr (sizeof(Scalar<Real>) == sizeof(float)) {
    return load<Real>(p);
  } else if constexpr (kWidth<Real> == 1) {
    return *p;
  } else {
    Real r;
    load_double(p, r);
    return r;
  }
}

template <class Real>
inline Real take(const double* p) {
  return load<Real>(p);
}

/// The floats after and before a number.
inline float next_above(float a) {
  const std::int32_t b = float_bits(a);
  return bits_float(a == 0 ? 1 : a > 0 ? b + 1 : b - 1);
}
template <class Real>
inline Real next_above(const Real& a) {
  const Int<Real> b = float_bits(Real(a + Real(0)));  // no zero is -0
  return select(a < Real(0), bits_float(Int<Real>(b - 1)), bits_float(Int<Real>(b + 1)));
}
inline float next_below(float a) {
  return 0 - next_above(0 - a);
}
/// The greatest float not above, and the least not below, a number; NaN for NaN.
inline float round_down(double a) {
  const float r = static_cast<float>(a);
  return r > a ? next_below(r) : r;
}
inline float round_up(double a) {
  return 0 - round_down(0 - a);
}
/// Doubles that hold floats: kWideParts<Real> registers hold as many as one Real.
template <class Real>
struct WideOf {
  using Type = VDouble;
};
template <>
struct WideOf<float> {
  using Type = double;
};
template <>
struct WideOf<double> {
  using Type = double;
};
template <class Real>
using Wide = typename WideOf<Real>::Type;
template <class Real>
inline constexpr int kWideParts = kWidth<Real> / kWidth<Wide<Real>>;

/// Part i of the lanes, in double.
template <int i, class Real>
inline Wide<Real> to_double(const Real& a) {
  if constexpr (sizeof(Scalar<Real>) == sizeof(double))
    return a;
  else if constexpr (kWidth<Real> == 1)
    return static_cast<double>(a);
  else
    return part_to_double<i>(a);
}

/// All parts together, each rounded once.
template <class Real>
inline Real narrow(const Wide<Real> (&part)[kWideParts<Real>]) {
  if constexpr (sizeof(Scalar<Real>) == sizeof(double))
    return part[0];
  else if constexpr (kWidth<Real> == 1)
    return static_cast<float>(part[0]);
  else
    return narrow_parts(part);
}

}  // namespace grelha::GRELHA_ISA
