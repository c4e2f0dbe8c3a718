#pragma once
// With double_lanes.hpp the one file that names xsimd and intrinsics. Every hot header is compiled
// once per instruction set, inside a namespace of that set's name (GRELHA_ISA), so that no function
// of one copy can be linked into another.
//
// Lanes   one float per SIMD lane, as wide as the machine's registers: one ray a lane Block   the
// same, at most 8 wide: one primitive of a block a lane float   the scalar twin; every function
// below exists for it too, with the same bits DoubleLanes, double   the same in double precision,
// half as many lanes, for what is computed precisely Exact, ExactBlock     what primitives are
// tested in: Lanes and Block, or both DoubleLanes in copies compiled with GRELHA_DOUBLE
// Words<Lanes>, Words<float>   unsigned 32-bit integers beside them: + - * ^ & | << >>, == and ?:
// are written as for one
//
// Only + - * / sqrt, comparisons and selects: these give the same bits at every width. No
// reciprocal, no rsqrt, no fused multiply-add, no unary minus (it loses -0 on AVX-512).

#ifndef GRELHA_ISA
#error "define GRELHA_ISA (scalar, sse2, avx2, avx512) before headers that hold hot loops"
#endif

#include <cstdint>

#define GRELHA_ISA_scalar 1
#define GRELHA_ISA_sse2 2
#define GRELHA_ISA_avx2 3
#define GRELHA_ISA_avx512 4
#define GRELHA_ISA_scalar_double 1
#define GRELHA_ISA_sse2_double 2
#define GRELHA_ISA_avx2_double 3
#define GRELHA_ISA_avx512_double 4
#define GRELHA_JOIN_(a, b) a##b
#define GRELHA_JOIN(a, b) GRELHA_JOIN_(a, b)
#define GRELHA_ISA_NUMBER GRELHA_JOIN(GRELHA_ISA_, GRELHA_ISA)

#if GRELHA_ISA_NUMBER > 1
#include <immintrin.h>
#include <xsimd/xsimd.hpp>
#endif

namespace grelha::GRELHA_ISA {

// ---- float, the scalar twin
// -------------------------------------------------------------------------------------

template <class Real>
struct LaneTraits;

template <>
struct LaneTraits<float> {
  using Scalar = float;
  using Mask = bool;
  using Int = std::int32_t;
  using Words = std::uint32_t;
  static constexpr int kWidth = 1;
};

template <>
struct LaneTraits<double> {
  using Scalar = double;
  using Mask = bool;
  static constexpr int kWidth = 1;
};

inline float select(bool m, float a, float b) { return m ? a : b; }
inline double select(bool m, double a, double b) { return m ? a : b; }
inline std::int32_t select_int(bool m, std::int32_t a, std::int32_t b) { return m ? a : b; }
inline float lesser(float a, float b) { return a < b ? a : b; }   ///< b when either is NaN
inline float greater(float a, float b) { return a > b ? a : b; }  ///< b when either is NaN
inline double lesser(double a, double b) { return a < b ? a : b; }
inline double greater(double a, double b) { return a > b ? a : b; }
inline float square_root(float a) { return __builtin_sqrtf(a); }
inline double square_root(double a) { return __builtin_sqrt(a); }
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
inline void load(const double* p, double& r) { r = *p; }
inline void store(float* p, float a) { *p = a; }
inline void store(double* p, double a) { *p = a; }
/// whether any lane is not 0
inline bool any_set(std::uint32_t a) { return a != 0; }
inline float small_to_float(std::uint32_t a) { return static_cast<float>(a); }  ///< a < 2^24: exact

// ---- SIMD
// ------------------------------------------------------------------------------------------

#if GRELHA_ISA_NUMBER == 1

using Lanes = float;
using Block = float;
using DoubleLanes = double;

#else

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

#if GRELHA_ISA_NUMBER == 2
using Lanes = Simd<xsimd::sse2>;
using Block = Lanes;
using DoubleLanes = SimdDouble<xsimd::sse2>;
#elif GRELHA_ISA_NUMBER == 3
using Lanes = Simd<xsimd::avx2>;
using Block = Lanes;
using DoubleLanes = SimdDouble<xsimd::avx2>;
#else
using Lanes = Simd<xsimd::avx512bw>;
using Block = Simd<xsimd::avx2>;
using DoubleLanes = SimdDouble<xsimd::avx512bw>;
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
inline SimdMask<xsimd::sse2> but_not(const SimdMask<xsimd::sse2>& a,
                                     const SimdMask<xsimd::sse2>& b) {
  return SimdMask<xsimd::sse2>(_mm_andnot_ps(b.data, a.data));
}
inline bool any_set(SimdWords<xsimd::sse2>::Type a) {
  return _mm_movemask_epi8(_mm_cmpeq_epi32(reinterpret_cast<__m128i>(a), _mm_setzero_si128())) !=
         0xFFFF;
}
inline Lanes small_to_float(SimdWords<xsimd::sse2>::Type a) {
  return Lanes(_mm_cvtepi32_ps(reinterpret_cast<__m128i>(a)));
}
#else
inline Simd<xsimd::avx2> lesser(const Simd<xsimd::avx2>& a, const Simd<xsimd::avx2>& b) {
  return Simd<xsimd::avx2>(_mm256_min_ps(a.data, b.data));
}
inline Simd<xsimd::avx2> greater(const Simd<xsimd::avx2>& a, const Simd<xsimd::avx2>& b) {
  return Simd<xsimd::avx2>(_mm256_max_ps(a.data, b.data));
}
inline unsigned bits(const SimdMask<xsimd::avx2>& m) {
  return unsigned(_mm256_movemask_ps(m.data));
}
inline SimdMask<xsimd::avx2> but_not(const SimdMask<xsimd::avx2>& a,
                                     const SimdMask<xsimd::avx2>& b) {
  return SimdMask<xsimd::avx2>(_mm256_andnot_ps(b.data, a.data));
}
#endif
#if GRELHA_ISA_NUMBER == 3
inline bool any_set(SimdWords<xsimd::avx2>::Type a) {
  const __m256i w = reinterpret_cast<__m256i>(a);
  return _mm256_testz_si256(w, w) == 0;
}
inline Lanes small_to_float(SimdWords<xsimd::avx2>::Type a) {
  return Lanes(_mm256_cvtepi32_ps(reinterpret_cast<__m256i>(a)));
}
#endif
#if GRELHA_ISA_NUMBER == 4
inline Lanes lesser(const Lanes& a, const Lanes& b) { return Lanes(_mm512_min_ps(a.data, b.data)); }
inline Lanes greater(const Lanes& a, const Lanes& b) {
  return Lanes(_mm512_max_ps(a.data, b.data));
}
inline unsigned bits(const SimdMask<xsimd::avx512bw>& m) { return unsigned(m.data); }
inline SimdMask<xsimd::avx512bw> but_not(const SimdMask<xsimd::avx512bw>& a,
                                         const SimdMask<xsimd::avx512bw>& b) {
  return SimdMask<xsimd::avx512bw>(static_cast<__mmask16>(a.data & ~b.data));
}
inline bool any_set(SimdWords<xsimd::avx512bw>::Type a) {
  const __m512i w = reinterpret_cast<__m512i>(a);
  return _mm512_test_epi32_mask(w, w) != 0;
}
inline Lanes small_to_float(SimdWords<xsimd::avx512bw>::Type a) {
  return Lanes(_mm512_cvtepi32_ps(reinterpret_cast<__m512i>(a)));
}
#endif

template <class A>
inline bool any(const SimdMask<A>& m) {
  return bits(m) != 0;
}
template <class A>
inline bool none(const SimdMask<A>& m) {
  return bits(m) == 0;
}

}  // namespace grelha::GRELHA_ISA
#include "kernel/simd/double_lanes.hpp"
namespace grelha::GRELHA_ISA {
#endif

/// Least and greatest of the lanes, none of them NaN.
#if GRELHA_ISA_NUMBER == 1
inline float lane_min(float a) { return a; }
inline float lane_max(float a) { return a; }
#else
template <class Take4, class Take1>
inline float lane_extreme(__m128 v, const Take4& take4, const Take1& take1) {
  v = take4(v, _mm_movehl_ps(v, v));
  return _mm_cvtss_f32(take1(v, _mm_shuffle_ps(v, v, 1)));
}
inline float lane_min(const Simd<xsimd::sse2>& a) {
  return lane_extreme(
      a.data,
      [](__m128 x, __m128 y) { return _mm_min_ps(x, y); },
      [](__m128 x, __m128 y) { return _mm_min_ss(x, y); });
}
inline float lane_max(const Simd<xsimd::sse2>& a) {
  return lane_extreme(
      a.data,
      [](__m128 x, __m128 y) { return _mm_max_ps(x, y); },
      [](__m128 x, __m128 y) { return _mm_max_ss(x, y); });
}
#if GRELHA_ISA_NUMBER > 2
inline float lane_min(const Simd<xsimd::avx2>& a) {
  return lane_min(Simd<xsimd::sse2>(
      _mm_min_ps(_mm256_castps256_ps128(a.data), _mm256_extractf128_ps(a.data, 1))));
}
inline float lane_max(const Simd<xsimd::avx2>& a) {
  return lane_max(Simd<xsimd::sse2>(
      _mm_max_ps(_mm256_castps256_ps128(a.data), _mm256_extractf128_ps(a.data, 1))));
}
#endif
#if GRELHA_ISA_NUMBER > 3
inline float lane_min(const Lanes& a) {
  return lane_min(
      lesser(Block(_mm512_castps512_ps256(a.data)), Block(_mm512_extractf32x8_ps(a.data, 1))));
}
inline float lane_max(const Lanes& a) {
  return lane_max(
      greater(Block(_mm512_castps512_ps256(a.data)), Block(_mm512_extractf32x8_ps(a.data, 1))));
}
#endif
#endif

/// Numbers without their fractions, of [0, 2^24); bytes at places `at` of an array that has three
/// more behind its last.
#if GRELHA_ISA_NUMBER == 1
inline float whole(float a) { return static_cast<float>(static_cast<std::int32_t>(a)); }
inline std::uint32_t to_words(float a) { return static_cast<std::uint32_t>(a); }
inline float bytes_at(const std::uint8_t* from, std::uint32_t at) { return from[at]; }
#else
inline Lanes whole(const Lanes& a) { return xsimd::to_float(xsimd::to_int(a)); }
inline LaneTraits<Lanes>::Words to_words(const Lanes& a) {
  return reinterpret_cast<LaneTraits<Lanes>::Words>(xsimd::to_int(a).data);
}
inline Lanes bytes_at(const std::uint8_t* from, LaneTraits<Lanes>::Words at) {
#if GRELHA_ISA_NUMBER == 2
  return Lanes(_mm_cvtepi32_ps(_mm_setr_epi32(from[at[0]], from[at[1]], from[at[2]], from[at[3]])));
#elif GRELHA_ISA_NUMBER == 3
  const __m256i four =
      _mm256_i32gather_epi32(reinterpret_cast<const int*>(from), reinterpret_cast<__m256i>(at), 1);
  return Lanes(_mm256_cvtepi32_ps(_mm256_and_si256(four, _mm256_set1_epi32(255))));
#else
  const __m512i four =
      _mm512_i32gather_epi32(reinterpret_cast<__m512i>(at), reinterpret_cast<const int*>(from), 1);
  return Lanes(_mm512_cvtepi32_ps(_mm512_and_si512(four, _mm512_set1_epi32(255))));
#endif
}
#endif

/// The lanes in which a comparison of words holds.
inline bool mask_of(std::uint32_t a) { return a != 0; }
/// Numbers and words at places `at` < 2^31 of an array.
inline float floats_at(const float* from, std::uint32_t at) { return from[at]; }
inline std::uint32_t words_at(const std::uint32_t* from, std::uint32_t at) { return from[at]; }
#if GRELHA_ISA_NUMBER == 2
inline SimdMask<xsimd::sse2> mask_of(LaneTraits<Lanes>::Words a) {
  return SimdMask<xsimd::sse2>(reinterpret_cast<__m128>(a));
}
inline Lanes floats_at(const float* from, LaneTraits<Lanes>::Words at) {
  return Lanes(_mm_setr_ps(from[at[0]], from[at[1]], from[at[2]], from[at[3]]));
}
inline LaneTraits<Lanes>::Words words_at(const std::uint32_t* from, LaneTraits<Lanes>::Words at) {
  return LaneTraits<Lanes>::Words{from[at[0]], from[at[1]], from[at[2]], from[at[3]]};
}
#elif GRELHA_ISA_NUMBER == 3
inline SimdMask<xsimd::avx2> mask_of(LaneTraits<Lanes>::Words a) {
  return SimdMask<xsimd::avx2>(reinterpret_cast<__m256>(a));
}
inline Lanes floats_at(const float* from, LaneTraits<Lanes>::Words at) {
  return Lanes(_mm256_i32gather_ps(from, reinterpret_cast<__m256i>(at), 4));
}
inline LaneTraits<Lanes>::Words words_at(const std::uint32_t* from, LaneTraits<Lanes>::Words at) {
  return reinterpret_cast<LaneTraits<Lanes>::Words>(
      _mm256_i32gather_epi32(reinterpret_cast<const int*>(from), reinterpret_cast<__m256i>(at), 4));
}
#elif GRELHA_ISA_NUMBER == 4
inline SimdMask<xsimd::avx512bw> mask_of(LaneTraits<Lanes>::Words a) {
  return SimdMask<xsimd::avx512bw>(_mm512_movepi32_mask(reinterpret_cast<__m512i>(a)));
}
inline Lanes floats_at(const float* from, LaneTraits<Lanes>::Words at) {
  return Lanes(_mm512_i32gather_ps(reinterpret_cast<__m512i>(at), from, 4));
}
inline LaneTraits<Lanes>::Words words_at(const std::uint32_t* from, LaneTraits<Lanes>::Words at) {
  return reinterpret_cast<LaneTraits<Lanes>::Words>(
      _mm512_i32gather_epi32(reinterpret_cast<__m512i>(at), reinterpret_cast<const int*>(from), 4));
}
#endif

#if GRELHA_ISA_NUMBER == 3
/// Row m: the numbers of the bits set in m, a byte each.
struct SetBits {
  std::uint64_t row[256];
  constexpr SetBits() : row{} {
    for (unsigned m = 0; m < 256; ++m)
      for (std::uint64_t k = 0, at = 0; k < 8; ++k)
        if (m >> k & 1) {
          row[m] |= k << at;
          at += 8;
        }
  }
};
inline constexpr SetBits kSetBits;
#endif

/// Lanes to be stored one behind another. A store may write as much as all lanes would take.
class Chosen {
 public:
  explicit Chosen(unsigned lanes) : lanes_(lanes) {}
  int count() const { return __builtin_popcount(lanes_); }
  /// T: float or std::uint32_t, from Lanes or their Words.
  template <class T, class Vector>
  void store(T* to, const Vector& a) const {
#if GRELHA_ISA_NUMBER == 3
    const __m256i order = _mm256_cvtepu8_epi32(
        _mm_loadl_epi64(reinterpret_cast<const __m128i*>(kSetBits.row + lanes_)));
    __m256i v;
    __builtin_memcpy(&v, &a, sizeof v);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_permutevar8x32_epi32(v, order));
#elif GRELHA_ISA_NUMBER == 4
    __m512i v;
    __builtin_memcpy(&v, &a, sizeof v);
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(lanes_), v));
#else
    T v[LaneTraits<Lanes>::kWidth];
    __builtin_memcpy(v, &a, sizeof v);
    for (unsigned left = lanes_; left != 0; left &= left - 1)
      *to++ = v[__builtin_ctz(left)];
#endif
  }
  /// The same of three components.
  template <class Vector>
  void store(float* x, float* y, float* z, const Vector& a) const {
    store(x, a.x);
    store(y, a.y);
    store(z, a.z);
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
#ifdef GRELHA_DOUBLE
inline constexpr bool kDouble = true;
using Exact = DoubleLanes;
using ExactBlock = DoubleLanes;
#else
inline constexpr bool kDouble = false;
using Exact = Lanes;
using ExactBlock = Block;
#endif
using Number = Scalar<Exact>;

/// Floats as they are, or widened.
template <class Real>
inline Real take(const float* p) {
  if constexpr (sizeof(Scalar<Real>) == sizeof(float))
    return load<Real>(p);
#if GRELHA_ISA_NUMBER == 2
  else
    return Real(
        _mm_cvtps_pd(_mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(p)))));
#elif GRELHA_ISA_NUMBER == 3
  else
    return Real(_mm256_cvtps_pd(_mm_loadu_ps(p)));
#elif GRELHA_ISA_NUMBER == 4
  else
    return Real(_mm512_cvtps_pd(_mm256_loadu_ps(p)));
#else
  else
    return *p;
#endif
}

template <class Real>
inline Real take(const double* p) {
  return load<Real>(p);
}

/// The greatest float not above, and the least not below, a number; NaN for NaN.
inline float not_above(double a) {
  const float r = static_cast<float>(a);
  if (!(r > a))
    return r;
  const std::int32_t b = float_bits(r);
  return r == 0 ? bits_float(INT32_MIN + 1) : bits_float(r > 0 ? b - 1 : b + 1);
}
#if GRELHA_ISA_NUMBER == 1
inline void store_narrow(float* p, double a) { *p = static_cast<float>(a); }
#elif GRELHA_ISA_NUMBER == 2
inline void store_narrow(float* p, const DoubleLanes& a) {
  _mm_storel_epi64(reinterpret_cast<__m128i*>(p), _mm_castps_si128(_mm_cvtpd_ps(a.data)));
}
#elif GRELHA_ISA_NUMBER == 3
inline void store_narrow(float* p, const DoubleLanes& a) {
  _mm_storeu_ps(p, _mm256_cvtpd_ps(a.data));
}
#else
inline void store_narrow(float* p, const DoubleLanes& a) {
  _mm256_storeu_ps(p, _mm512_cvtpd_ps(a.data));
}
#endif
inline float not_below(double a) { return 0 - not_above(0 - a); }

/// Doubles beside some floats: kWideParts<Real> registers of them hold what one of Real does.
template <class Real>
struct WideOf {
  using Type = DoubleLanes;
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
inline Wide<Real> widen(const Real& a) {
  if constexpr (sizeof(Scalar<Real>) == sizeof(double))
    return a;
  else if constexpr (kWidth<Real> == 1)
    return static_cast<double>(a);
#if GRELHA_ISA_NUMBER == 2
  else
    return DoubleLanes(_mm_cvtps_pd(i == 0 ? a.data : _mm_movehl_ps(a.data, a.data)));
#elif GRELHA_ISA_NUMBER == 3
  else
    return DoubleLanes(_mm256_cvtps_pd(_mm256_extractf128_ps(a.data, i)));
#elif GRELHA_ISA_NUMBER == 4
  else if constexpr (kWideParts<Real> == 1)
    return DoubleLanes(_mm512_cvtps_pd(a.data));
  else
    return DoubleLanes(_mm512_cvtps_pd(_mm512_extractf32x8_ps(a.data, i)));
#endif
}

/// All parts together, each rounded once.
template <class Real>
inline Real narrow(const Wide<Real> (&part)[kWideParts<Real>]) {
  if constexpr (sizeof(Scalar<Real>) == sizeof(double))
    return part[0];
  else if constexpr (kWidth<Real> == 1)
    return static_cast<float>(part[0]);
#if GRELHA_ISA_NUMBER == 2
  else
    return Real(_mm_movelh_ps(_mm_cvtpd_ps(part[0].data), _mm_cvtpd_ps(part[1].data)));
#elif GRELHA_ISA_NUMBER == 3
  else
    return Real(_mm256_set_m128(_mm256_cvtpd_ps(part[1].data), _mm256_cvtpd_ps(part[0].data)));
#elif GRELHA_ISA_NUMBER == 4
  else if constexpr (kWideParts<Real> == 1)
    return Real(_mm512_cvtpd_ps(part[0].data));
  else
    return Real(_mm512_insertf32x8(
        _mm512_castps256_ps512(_mm512_cvtpd_ps(part[0].data)), _mm512_cvtpd_ps(part[1].data), 1));
#endif
}

/// |a|.
inline float magnitude(float a) { return __builtin_fabsf(a); }
inline double magnitude(double a) { return __builtin_fabs(a); }
#if GRELHA_ISA_NUMBER > 1
template <class A>
inline Simd<A> magnitude(const Simd<A>& a) {
  return xsimd::abs(a);
}
template <class A>
inline SimdDouble<A> magnitude(const SimdDouble<A>& a) {
  return xsimd::abs(a);
}
#endif

}  // namespace grelha::GRELHA_ISA
