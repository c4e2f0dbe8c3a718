#pragma once
// The functions of lanes.hpp for the sixteen floats and eight doubles of AVX-512's registers.

#include "kernel/base/lanes_avx2.hpp"

namespace grelha::GRELHA_ISA {

using VFloat = Simd<xsimd::avx512bw>;
using Block = Avx2;
using VDouble = SimdDouble<xsimd::avx512bw>;
using Avx512Mask = SimdMask<xsimd::avx512bw>;
using Avx512DoubleMask = SimdDoubleMask<xsimd::avx512bw>;
template <>
struct SimdWords<xsimd::avx512bw> {
  using Type = std::uint32_t __attribute__((vector_size(64)));
};
using Avx512Words = SimdWords<xsimd::avx512bw>::Type;

inline VFloat min(const VFloat& a, const VFloat& b) {
  return VFloat(_mm512_min_ps(a.data, b.data));
}
inline VFloat max(const VFloat& a, const VFloat& b) {
  return VFloat(_mm512_max_ps(a.data, b.data));
}
/// As lanes.hpp has it, in one instruction.
inline VFloat max_abs(const VFloat& a, const VFloat& b) {
  constexpr int magnitudes = 0b1011;
  return VFloat(_mm512_range_ps(a.data, b.data, magnitudes));
}
inline Block max_abs(const Block& a, const Block& b) {
  constexpr int magnitudes = 0b1011;
  return Block(_mm256_range_ps(a.data, b.data, magnitudes));
}
inline unsigned bits(const Avx512Mask& m) {
  return unsigned(m.data);
}
inline Avx512Mask and_not(const Avx512Mask& a, const Avx512Mask& b) {
  return Avx512Mask(static_cast<__mmask16>(a.data & ~b.data));
}
template <int places>
inline VFloat shuffled(const VFloat& a, const VFloat& b) {
  return VFloat(_mm512_shuffle_ps(a.data, b.data, places));
}
template <class Take>
inline Sse2 folded(const VFloat& a, const Take& take) {
  const Block low(_mm512_castps512_ps256(a.data));
  return folded(take(low, Block(_mm512_extractf32x8_ps(a.data, 1))), take);
}
inline float lane_min(const VFloat& a) {
  return lane_min(
      min(Block(_mm512_castps512_ps256(a.data)), Block(_mm512_extractf32x8_ps(a.data, 1))));
}
inline float lane_max(const VFloat& a) {
  return lane_max(
      max(Block(_mm512_castps512_ps256(a.data)), Block(_mm512_extractf32x8_ps(a.data, 1))));
}

inline VDouble min(const VDouble& a, const VDouble& b) {
  return VDouble(_mm512_min_pd(a.data, b.data));
}
inline VDouble max(const VDouble& a, const VDouble& b) {
  return VDouble(_mm512_max_pd(a.data, b.data));
}
inline unsigned bits(const Avx512DoubleMask& m) {
  return unsigned(m.data);
}
inline Avx512DoubleMask and_not(const Avx512DoubleMask& a, const Avx512DoubleMask& b) {
  return Avx512DoubleMask(static_cast<__mmask8>(a.data & ~b.data));
}

inline bool any_set(Avx512Words a) {
  const __m512i w = reinterpret_cast<__m512i>(a);
  return _mm512_test_epi32_mask(w, w) != 0;
}
inline VFloat small_to_float(Avx512Words a) {
  return VFloat(_mm512_cvtepi32_ps(reinterpret_cast<__m512i>(a)));
}
inline Avx512Mask mask_of(Avx512Words a) {
  return Avx512Mask(_mm512_movepi32_mask(reinterpret_cast<__m512i>(a)));
}
inline VFloat floats_at(const float* from, Avx512Words at) {
  return VFloat(_mm512_i32gather_ps(reinterpret_cast<__m512i>(at), from, 4));
}
inline Avx512Words words_at(const std::uint32_t* from, Avx512Words at) {
  return reinterpret_cast<Avx512Words>(
      _mm512_i32gather_epi32(reinterpret_cast<__m512i>(at), reinterpret_cast<const int*>(from), 4));
}
inline VFloat bytes_at(const std::uint8_t* from, Avx512Words at) {
  const __m512i four =
      _mm512_i32gather_epi32(reinterpret_cast<__m512i>(at), reinterpret_cast<const int*>(from), 1);
  return VFloat(_mm512_cvtepi32_ps(_mm512_and_si512(four, _mm512_set1_epi32(255))));
}

inline void load_double(const float* p, VDouble& r) {
  r = VDouble(_mm512_cvtps_pd(_mm256_loadu_ps(p)));
}
inline void store_narrow(float* p, const VDouble& a) {
  _mm256_storeu_ps(p, _mm512_cvtpd_ps(a.data));
}
template <int i>
inline VDouble part_to_double(const VFloat& a) {
  return VDouble(_mm512_cvtps_pd(_mm512_extractf32x8_ps(a.data, i)));
}
template <int i>
inline VDouble part_to_double(const Block& a) {
  return VDouble(_mm512_cvtps_pd(a.data));
}
inline VFloat narrow_parts(const VDouble (&part)[2]) {
  return VFloat(_mm512_insertf32x8(
      _mm512_castps256_ps512(_mm512_cvtpd_ps(part[0].data)), _mm512_cvtpd_ps(part[1].data), 1));
}
inline Block narrow_parts(const VDouble (&part)[1]) {
  return Block(_mm512_cvtpd_ps(part[0].data));
}

template <class T, class Vector>
requires(sizeof(Vector) == 64) inline void compress_store(T* to, const Vector& a, unsigned lanes) {
  __m512i v;
  __builtin_memcpy(&v, &a, sizeof v);
  _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(lanes), v));
}
template <class T, class Vector>
requires(sizeof(Vector) == 32) inline void compress_store(T* to, const Vector& a, unsigned lanes) {
  __m256i v;
  __builtin_memcpy(&v, &a, sizeof v);
  const __m256i compressed = _mm256_maskz_compress_epi32(static_cast<__mmask8>(lanes), v);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), compressed);
}

}  // namespace grelha::GRELHA_ISA
