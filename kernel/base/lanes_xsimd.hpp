#pragma once
// Functions that are the same for the lanes of every instruction set that xsimd knows. Those for
// doubles are spelled out: xsimd's own templates of the same names would be as good a match for one
// over both.

#include "kernel/base/lanes_scalar.hpp"

namespace grelha::GRELHA_ISA {

template <class Arch>
using Simd = xsimd::batch<float, Arch>;
template <class Arch>
using SimdDouble = xsimd::batch<double, Arch>;
template <class Arch>
using SimdMask = xsimd::batch_bool<float, Arch>;
template <class Arch>
using SimdDoubleMask = xsimd::batch_bool<double, Arch>;
template <class Arch>
using SimdInt = xsimd::batch<std::int32_t, Arch>;

/// The compiler's own vectors: it knows how to multiply where the instruction set does not.
template <class Arch>
struct SimdWords;

template <class Arch>
struct LaneTraits<Simd<Arch>> {
  using Scalar = float;
  using Mask = SimdMask<Arch>;
  using Int = SimdInt<Arch>;
  using Words = typename SimdWords<Arch>::Type;
  static constexpr int kWidth = int(Simd<Arch>::size);
};

template <class Arch>
struct LaneTraits<SimdDouble<Arch>> {
  using Scalar = double;
  using Mask = SimdDoubleMask<Arch>;
  static constexpr int kWidth = int(SimdDouble<Arch>::size);
};

template <class A>
inline Simd<A> select(const SimdMask<A>& m, const Simd<A>& a, const Simd<A>& b) {
  return xsimd::select(m, a, b);
}
template <class A>
inline SimdDouble<A> select(const SimdDoubleMask<A>& m,
                            const SimdDouble<A>& a,
                            const SimdDouble<A>& b) {
  return xsimd::select(m, a, b);
}
template <class A>
inline SimdMask<A> mask_and(const SimdMask<A>& a, const SimdMask<A>& b) {
  return a & b;
}
template <class A>
inline SimdDoubleMask<A> mask_and(const SimdDoubleMask<A>& a, const SimdDoubleMask<A>& b) {
  return a & b;
}
template <class A>
inline SimdMask<A> mask_or(const SimdMask<A>& a, const SimdMask<A>& b) {
  return a | b;
}
template <class A>
inline SimdDoubleMask<A> mask_or(const SimdDoubleMask<A>& a, const SimdDoubleMask<A>& b) {
  return a | b;
}
template <class A>
inline Simd<A> square_root(const Simd<A>& a) {
  return xsimd::sqrt(a);
}
template <class A>
inline SimdDouble<A> square_root(const SimdDouble<A>& a) {
  return xsimd::sqrt(a);
}
template <class A>
inline Simd<A> magnitude(const Simd<A>& a) {
  return xsimd::abs(a);
}
template <class A>
inline SimdDouble<A> magnitude(const SimdDouble<A>& a) {
  return xsimd::abs(a);
}
// xsimd's own cast takes a type of batches in older versions, one of lanes in newer ones.
template <class A>
inline SimdInt<A> float_bits(const Simd<A>& a) {
  return __builtin_bit_cast(SimdInt<A>, a);
}
template <class A>
inline Simd<A> bits_float(const SimdInt<A>& a) {
  return __builtin_bit_cast(Simd<A>, a);
}
template <class A>
inline Simd<A> to_float(const SimdInt<A>& a) {
  return xsimd::to_float(a);
}
template <class A>
inline SimdInt<A> to_int(const Simd<A>& a) {
  return xsimd::to_int(a);
}
template <class A>
inline Simd<A> whole(const Simd<A>& a) {
  return xsimd::to_float(xsimd::to_int(a));
}
template <class A>
inline typename SimdWords<A>::Type to_words(const Simd<A>& a) {
  return reinterpret_cast<typename SimdWords<A>::Type>(xsimd::to_int(a).data);
}
template <class A>
inline void load(const float* p, Simd<A>& r) {
  r = Simd<A>::load_unaligned(p);
}
template <class A>
inline void load(const double* p, SimdDouble<A>& r) {
  r = SimdDouble<A>::load_unaligned(p);
}
template <class A>
inline void store(float* p, const Simd<A>& a) {
  a.store_unaligned(p);
}
template <class A>
inline void store(double* p, const SimdDouble<A>& a) {
  a.store_unaligned(p);
}

}  // namespace grelha::GRELHA_ISA
