#pragma once
// The functions of lanes.hpp for the eight floats and four doubles of AVX2's registers.

#include "kernel/base/lanes_sse2.hpp"

namespace grelha::GRELHA_ISA {

using Avx2 = Simd<xsimd::avx2>;
using Avx2Mask = SimdMask<xsimd::avx2>;
using Avx2Double = SimdDouble<xsimd::avx2>;
using Avx2DoubleMask = SimdDoubleMask<xsimd::avx2>;
template <>
struct SimdWords<xsimd::avx2> {
  using Type = std::uint32_t __attribute__((vector_size(32)));
};
using Avx2Words = SimdWords<xsimd::avx2>::Type;

inline Avx2 min(const Avx2& a, const Avx2& b) {
  return Avx2(_mm256_min_ps(a.data, b.data));
}
inline Avx2 max(const Avx2& a, const Avx2& b) {
  return Avx2(_mm256_max_ps(a.data, b.data));
}
inline unsigned bits(const Avx2Mask& m) {
  return unsigned(_mm256_movemask_ps(m.data));
}
inline Avx2Mask and_not(const Avx2Mask& a, const Avx2Mask& b) {
  return Avx2Mask(_mm256_andnot_ps(b.data, a.data));
}
template <int places>
inline Avx2 shuffled(const Avx2& a, const Avx2& b) {
  return Avx2(_mm256_shuffle_ps(a.data, b.data, places));
}
template <class Take>
inline Sse2 folded(const Avx2& a, const Take& take) {
  return take(Sse2(_mm256_castps256_ps128(a.data)), Sse2(_mm256_extractf128_ps(a.data, 1)));
}
inline float lane_min(const Avx2& a) {
  return lane_min(folded(a, [](const Sse2& x, const Sse2& y) { return min(x, y); }));
}
inline float lane_max(const Avx2& a) {
  return lane_max(folded(a, [](const Sse2& x, const Sse2& y) { return max(x, y); }));
}

inline Avx2Mask mask_of(Avx2Words a) {
  return Avx2Mask(reinterpret_cast<__m256>(a));
}

#if GRELHA_ISA_NUMBER == 3

using VFloat = Avx2;
using Block = Avx2;
using VDouble = Avx2Double;

inline VDouble min(const VDouble& a, const VDouble& b) {
  return VDouble(_mm256_min_pd(a.data, b.data));
}
inline VDouble max(const VDouble& a, const VDouble& b) {
  return VDouble(_mm256_max_pd(a.data, b.data));
}
inline unsigned bits(const Avx2DoubleMask& m) {
  return unsigned(_mm256_movemask_pd(m.data));
}
inline Avx2DoubleMask and_not(const Avx2DoubleMask& a, const Avx2DoubleMask& b) {
  return Avx2DoubleMask(_mm256_andnot_pd(b.data, a.data));
}

inline bool any_set(Avx2Words a) {
  const __m256i w = reinterpret_cast<__m256i>(a);
  return _mm256_testz_si256(w, w) == 0;
}
inline VFloat small_to_float(Avx2Words a) {
  return VFloat(_mm256_cvtepi32_ps(reinterpret_cast<__m256i>(a)));
}
inline VFloat floats_at(const float* from, Avx2Words at) {
  return VFloat(_mm256_i32gather_ps(from, reinterpret_cast<__m256i>(at), 4));
}
inline Avx2Words words_at(const std::uint32_t* from, Avx2Words at) {
  return reinterpret_cast<Avx2Words>(
      _mm256_i32gather_epi32(reinterpret_cast<const int*>(from), reinterpret_cast<__m256i>(at), 4));
}
inline VFloat bytes_at(const std::uint8_t* from, Avx2Words at) {
  const __m256i four =
      _mm256_i32gather_epi32(reinterpret_cast<const int*>(from), reinterpret_cast<__m256i>(at), 1);
  return VFloat(_mm256_cvtepi32_ps(_mm256_and_si256(four, _mm256_set1_epi32(255))));
}

inline void load_double(const float* p, VDouble& r) {
  r = VDouble(_mm256_cvtps_pd(_mm_loadu_ps(p)));
}
inline void store_narrow(float* p, const VDouble& a) {
  _mm_storeu_ps(p, _mm256_cvtpd_ps(a.data));
}
template <int i>
inline VDouble part_to_double(const VFloat& a) {
  return VDouble(_mm256_cvtps_pd(_mm256_extractf128_ps(a.data, i)));
}
inline VFloat narrow_parts(const VDouble (&part)[2]) {
  return VFloat(_mm256_set_m128(_mm256_cvtpd_ps(part[1].data), _mm256_cvtpd_ps(part[0].data)));
}

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

template <class T, class Vector>
requires(sizeof(Vector) == 32) inline void compress_store(T* to, const Vector& a, unsigned lanes) {
  const __m256i order =
      _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(kSetBits.row + lanes)));
  __m256i v;
  __builtin_memcpy(&v, &a, sizeof v);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_permutevar8x32_epi32(v, order));
}

#endif

}  // namespace grelha::GRELHA_ISA
