#pragma once
// The one file that names xsimd and intrinsics. Every hot header is compiled once per instruction set, inside a
// namespace of that set's name (GRELHA_ISA), so that no function of one copy can be linked into another.
//
//   Lanes   one float per SIMD lane, as wide as the machine's registers: one ray a lane
//   Block   the same, at most 8 wide: one primitive of a block a lane
//   float   the scalar twin; every function below exists for it too, with the same bits
//   Words<Lanes>, Words<float>   unsigned 32-bit integers beside them: + - * ^ & | << >>, == and ?: are written as for one
//
// Only + - * / sqrt, comparisons and selects: these give the same bits at every width. No reciprocal, no rsqrt, no
// fused multiply-add, no unary minus (it loses -0 on AVX-512).

#ifndef GRELHA_ISA
#error "define GRELHA_ISA (scalar, sse2, avx2, avx512) before including kernel headers that hold hot loops"
#endif

#include <cstdint>

#define GRELHA_ISA_scalar 1
#define GRELHA_ISA_sse2 2
#define GRELHA_ISA_avx2 3
#define GRELHA_ISA_avx512 4
#define GRELHA_JOIN_(a, b) a##b
#define GRELHA_JOIN(a, b) GRELHA_JOIN_(a, b)
#define GRELHA_ISA_NUMBER GRELHA_JOIN(GRELHA_ISA_, GRELHA_ISA)

#if GRELHA_ISA_NUMBER > 1
#include <immintrin.h>
#include <xsimd/xsimd.hpp>
#endif

namespace grelha::GRELHA_ISA {

// ---- float, the scalar twin -------------------------------------------------------------------------------------

template <class Real>
struct LaneTraits;

template <>
struct LaneTraits<float> {
  using Mask = bool;
  using Int = std::int32_t;
  using Words = std::uint32_t;
  static constexpr int kWidth = 1;
};

inline float select(bool m, float a, float b) { return m ? a : b; }
inline std::int32_t select_int(bool m, std::int32_t a, std::int32_t b) { return m ? a : b; }
inline float lesser(float a, float b) { return a < b ? a : b; }   ///< b when either is NaN
inline float greater(float a, float b) { return a > b ? a : b; }  ///< b when either is NaN
inline float square_root(float a) { return __builtin_sqrtf(a); }
inline bool any(bool m) { return m; }
inline bool none(bool m) { return !m; }
inline unsigned bits(bool m) { return m; }
inline bool both(bool a, bool b) { return a & b; }
inline bool either(bool a, bool b) { return a | b; }
inline bool but_not(bool a, bool b) { return a & !b; }
inline std::int32_t float_bits(float a) {
  std::int32_t r;
  __builtin_memcpy(&r, &a, 4);
  return r;
}
inline float bits_float(std::int32_t a) {
  float r;
  __builtin_memcpy(&r, &a, 4);
  return r;
}
inline std::int32_t to_int(float a) { return static_cast<std::int32_t>(a); }
inline float to_float(std::int32_t a) { return static_cast<float>(a); }
inline void load(const float* p, float& r) { r = *p; }
inline void store(float* p, float a) { *p = a; }
inline bool any_set(std::uint32_t a) { return a != 0; }                           ///< whether any lane is not 0
inline float small_to_float(std::uint32_t a) { return static_cast<float>(a); }  ///< a < 2^24: exact

// ---- SIMD -------------------------------------------------------------------------------------------------------

#if GRELHA_ISA_NUMBER == 1

using Lanes = float;
using Block = float;

#else

template <class Arch>
using Simd = xsimd::batch<float, Arch>;
template <class Arch>
using SimdMask = xsimd::batch_bool<float, Arch>;
template <class Arch>
using SimdInt = xsimd::batch<std::int32_t, Arch>;

// The compiler's own vectors: it knows how to multiply where the instruction set does not.
template <class Arch>
struct SimdWords;
template <>
struct SimdWords<xsimd::sse2> {
  using Type = std::uint32_t __attribute__((vector_size(16)));
};
template <>
struct SimdWords<xsimd::avx2> {
  using Type = std::uint32_t __attribute__((vector_size(32)));
};
template <>
struct SimdWords<xsimd::avx512bw> {
  using Type = std::uint32_t __attribute__((vector_size(64)));
};

template <class Arch>
struct LaneTraits<Simd<Arch>> {
  using Mask = SimdMask<Arch>;
  using Int = SimdInt<Arch>;
  using Words = typename SimdWords<Arch>::Type;
  static constexpr int kWidth = int(Simd<Arch>::size);
};

#if GRELHA_ISA_NUMBER == 2
using Lanes = Simd<xsimd::sse2>;
using Block = Lanes;
#elif GRELHA_ISA_NUMBER == 3
using Lanes = Simd<xsimd::avx2>;
using Block = Lanes;
#else
using Lanes = Simd<xsimd::avx512bw>;
using Block = Simd<xsimd::avx2>;
#endif

template <class A>
inline Simd<A> select(const SimdMask<A>& m, const Simd<A>& a, const Simd<A>& b) {
  return xsimd::select(m, a, b);
}
template <class A>
inline SimdMask<A> both(const SimdMask<A>& a, const SimdMask<A>& b) {
  return a & b;
}
template <class A>
inline SimdMask<A> either(const SimdMask<A>& a, const SimdMask<A>& b) {
  return a | b;
}
template <class A>
inline Simd<A> square_root(const Simd<A>& a) {
  return xsimd::sqrt(a);
}
template <class A>
inline SimdInt<A> float_bits(const Simd<A>& a) {
  return xsimd::bitwise_cast<SimdInt<A>>(a);
}
template <class A>
inline Simd<A> bits_float(const SimdInt<A>& a) {
  return xsimd::bitwise_cast<Simd<A>>(a);
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
inline void load(const float* p, Simd<A>& r) {
  r = Simd<A>::load_unaligned(p);
}
template <class A>
inline void store(float* p, const Simd<A>& a) {
  a.store_unaligned(p);
}

// minps and maxps are exactly the selects of the scalar twin, NaN and signed zeros included.
// but_not(a, b): a and not b, lane by lane. bits(m): bit i is lane i.
#if GRELHA_ISA_NUMBER == 2
inline Lanes lesser(const Lanes& a, const Lanes& b) { return Lanes(_mm_min_ps(a.data, b.data)); }
inline Lanes greater(const Lanes& a, const Lanes& b) { return Lanes(_mm_max_ps(a.data, b.data)); }
inline unsigned bits(const SimdMask<xsimd::sse2>& m) { return unsigned(_mm_movemask_ps(m.data)); }
inline SimdMask<xsimd::sse2> but_not(const SimdMask<xsimd::sse2>& a, const SimdMask<xsimd::sse2>& b) {
  return SimdMask<xsimd::sse2>(_mm_andnot_ps(b.data, a.data));
}
inline bool any_set(SimdWords<xsimd::sse2>::Type a) {
  return _mm_movemask_epi8(_mm_cmpeq_epi32(reinterpret_cast<__m128i>(a), _mm_setzero_si128())) != 0xFFFF;
}
inline Lanes small_to_float(SimdWords<xsimd::sse2>::Type a) { return Lanes(_mm_cvtepi32_ps(reinterpret_cast<__m128i>(a))); }
#else
inline Simd<xsimd::avx2> lesser(const Simd<xsimd::avx2>& a, const Simd<xsimd::avx2>& b) {
  return Simd<xsimd::avx2>(_mm256_min_ps(a.data, b.data));
}
inline Simd<xsimd::avx2> greater(const Simd<xsimd::avx2>& a, const Simd<xsimd::avx2>& b) {
  return Simd<xsimd::avx2>(_mm256_max_ps(a.data, b.data));
}
inline unsigned bits(const SimdMask<xsimd::avx2>& m) { return unsigned(_mm256_movemask_ps(m.data)); }
inline SimdMask<xsimd::avx2> but_not(const SimdMask<xsimd::avx2>& a, const SimdMask<xsimd::avx2>& b) {
  return SimdMask<xsimd::avx2>(_mm256_andnot_ps(b.data, a.data));
}
#endif
#if GRELHA_ISA_NUMBER == 3
inline bool any_set(SimdWords<xsimd::avx2>::Type a) {
  const __m256i w = reinterpret_cast<__m256i>(a);
  return _mm256_testz_si256(w, w) == 0;
}
inline Lanes small_to_float(SimdWords<xsimd::avx2>::Type a) { return Lanes(_mm256_cvtepi32_ps(reinterpret_cast<__m256i>(a))); }
#endif
#if GRELHA_ISA_NUMBER == 4
inline Lanes lesser(const Lanes& a, const Lanes& b) { return Lanes(_mm512_min_ps(a.data, b.data)); }
inline Lanes greater(const Lanes& a, const Lanes& b) { return Lanes(_mm512_max_ps(a.data, b.data)); }
inline unsigned bits(const SimdMask<xsimd::avx512bw>& m) { return unsigned(m.data); }
inline SimdMask<xsimd::avx512bw> but_not(const SimdMask<xsimd::avx512bw>& a, const SimdMask<xsimd::avx512bw>& b) {
  return SimdMask<xsimd::avx512bw>(static_cast<__mmask16>(a.data & ~b.data));
}
inline bool any_set(SimdWords<xsimd::avx512bw>::Type a) {
  const __m512i w = reinterpret_cast<__m512i>(a);
  return _mm512_test_epi32_mask(w, w) != 0;
}
inline Lanes small_to_float(SimdWords<xsimd::avx512bw>::Type a) { return Lanes(_mm512_cvtepi32_ps(reinterpret_cast<__m512i>(a))); }
#endif

template <class A>
inline bool any(const SimdMask<A>& m) {
  return bits(m) != 0;
}
template <class A>
inline bool none(const SimdMask<A>& m) {
  return bits(m) == 0;
}

#endif

template <class Real>
using Mask = typename LaneTraits<Real>::Mask;
template <class Real>
using Int = typename LaneTraits<Real>::Int;
template <class Real>
using Words = typename LaneTraits<Real>::Words;
template <class Real>
inline constexpr int kWidth = LaneTraits<Real>::kWidth;

template <class Real>
inline Real load(const float* p) {
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
template <class Word>
inline void store_words(std::uint32_t* p, const Word& a) {
  __builtin_memcpy(p, &a, sizeof a);
}
/// first, first + 1, ... one a lane.
template <class Real>
inline Words<Real> counted_words(std::uint32_t first) {
  std::uint32_t w[kWidth<Real>];
  for (int k = 0; k < kWidth<Real>; ++k) w[k] = first + static_cast<std::uint32_t>(k);
  return load_words<Real>(w);
}
/// |a| without touching the sign bit of anything else.
template <class Real>
inline Real magnitude(const Real& a) {
  return greater(a, Real(0) - a);
}

}  // namespace grelha::GRELHA_ISA
