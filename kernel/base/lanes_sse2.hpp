#pragma once
// The functions of lanes.hpp for the four floats and two doubles of SSE2's registers.
//
// minps and maxps are exactly the selects of the scalar twin, NaN and signed zeros included.

#include "kernel/base/lanes_xsimd.hpp"

namespace grelha::GRELHA_ISA {

using Sse2 = Simd<xsimd::sse2>;
using Sse2Mask = SimdMask<xsimd::sse2>;
using Sse2Double = SimdDouble<xsimd::sse2>;
using Sse2DoubleMask = SimdDoubleMask<xsimd::sse2>;
template <>
struct SimdWords<xsimd::sse2> {
  using Type = std::uint32_t __attribute__((vector_size(16)));
};
using Sse2Words = SimdWords<xsimd::sse2>::Type;

inline Sse2 min(const Sse2& a, const Sse2& b) {
  return Sse2(_mm_min_ps(a.data, b.data));
}
inline Sse2 max(const Sse2& a, const Sse2& b) {
  return Sse2(_mm_max_ps(a.data, b.data));
}
inline unsigned bits(const Sse2Mask& m) {
  return unsigned(_mm_movemask_ps(m.data));
}
inline Sse2Mask and_not(const Sse2Mask& a, const Sse2Mask& b) {
  return Sse2Mask(_mm_andnot_ps(b.data, a.data));
}

inline Sse2Double min(const Sse2Double& a, const Sse2Double& b) {
  return Sse2Double(_mm_min_pd(a.data, b.data));
}
inline Sse2Double max(const Sse2Double& a, const Sse2Double& b) {
  return Sse2Double(_mm_max_pd(a.data, b.data));
}
inline unsigned bits(const Sse2DoubleMask& m) {
  return unsigned(_mm_movemask_pd(m.data));
}
inline Sse2DoubleMask and_not(const Sse2DoubleMask& a, const Sse2DoubleMask& b) {
  return Sse2DoubleMask(_mm_andnot_pd(b.data, a.data));
}

inline bool any_set(Sse2Words a) {
  const __m128i zero = _mm_cmpeq_epi32(reinterpret_cast<__m128i>(a), _mm_setzero_si128());
  return _mm_movemask_epi8(zero) != 0xFFFF;
}
inline Sse2 small_to_float(Sse2Words a) {
  return Sse2(_mm_cvtepi32_ps(reinterpret_cast<__m128i>(a)));
}
inline Sse2Mask mask_of(Sse2Words a) {
  return Sse2Mask(reinterpret_cast<__m128>(a));
}
inline Sse2 floats_at(const float* from, Sse2Words at) {
  return Sse2(_mm_setr_ps(from[at[0]], from[at[1]], from[at[2]], from[at[3]]));
}
inline Sse2Words words_at(const std::uint32_t* from, Sse2Words at) {
  return Sse2Words{from[at[0]], from[at[1]], from[at[2]], from[at[3]]};
}
inline Sse2 bytes_at(const std::uint8_t* from, Sse2Words at) {
  return Sse2(_mm_cvtepi32_ps(_mm_setr_epi32(from[at[0]], from[at[1]], from[at[2]], from[at[3]])));
}

template <class Take4, class Take1>
inline float lane_extreme(__m128 v, const Take4& take4, const Take1& take1) {
  v = take4(v, _mm_movehl_ps(v, v));
  return _mm_cvtss_f32(take1(v, _mm_shuffle_ps(v, v, 1)));
}
inline float lane_min(const Sse2& a) {
  return lane_extreme(
      a.data,
      [](__m128 x, __m128 y) { return _mm_min_ps(x, y); },
      [](__m128 x, __m128 y) { return _mm_min_ss(x, y); });
}
inline float lane_max(const Sse2& a) {
  return lane_extreme(
      a.data,
      [](__m128 x, __m128 y) { return _mm_max_ps(x, y); },
      [](__m128 x, __m128 y) { return _mm_max_ss(x, y); });
}

/// Two places of `a`, then two of `b`, of each four lanes; `places` as of _mm_shuffle_ps.
template <int places>
inline Sse2 shuffled(const Sse2& a, const Sse2& b) {
  return Sse2(_mm_shuffle_ps(a.data, b.data, places));
}
/// Takes lanes four apart together, until four are left.
template <class Take>
inline Sse2 folded(const Sse2& a, const Take&) {
  return a;
}

#if GRELHA_ISA_NUMBER == 2

using VFloat = Sse2;
using Block = Sse2;
using VDouble = Sse2Double;

inline void load_double(const float* p, VDouble& r) {
  const __m128i two = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(p));
  r = VDouble(_mm_cvtps_pd(_mm_castsi128_ps(two)));
}
inline void store_narrow(float* p, const VDouble& a) {
  _mm_storel_epi64(reinterpret_cast<__m128i*>(p), _mm_castps_si128(_mm_cvtpd_ps(a.data)));
}
template <int i>
inline VDouble part_to_double(const VFloat& a) {
  return VDouble(_mm_cvtps_pd(i == 0 ? a.data : _mm_movehl_ps(a.data, a.data)));
}
inline VFloat narrow_parts(const VDouble (&part)[2]) {
  return VFloat(_mm_movelh_ps(_mm_cvtpd_ps(part[0].data), _mm_cvtpd_ps(part[1].data)));
}

#endif

}  // namespace grelha::GRELHA_ISA
