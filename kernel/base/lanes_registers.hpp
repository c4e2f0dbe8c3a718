#pragma once
// Masks as registers, and what xsimd computes otherwise than its lanes one by one.

#include <concepts>

#include "kernel/base/isa.hpp"

#if GRELHA_ISA_NUMBER == 5
/// Rounded once: that of xsimd 8 multiplies by an estimate of the inverse.
template <>
inline xsimd::batch<float, xsimd::neon64> xsimd::kernel::div<xsimd::neon64>(
    const xsimd::batch<float, xsimd::neon64>& a,
    const xsimd::batch<float, xsimd::neon64>& b,
    requires_arch<xsimd::neon>) noexcept {
  return vdivq_f32(a, b);
}
#endif

namespace grelha::GRELHA_ISA {

// A mask is a register of lanes, or a number with a bit a lane.
#if GRELHA_ISA_NUMBER == 5
inline unsigned register_bits(uint32x4_t m) {
  return vaddvq_u32(vandq_u32(m, uint32x4_t{1, 2, 4, 8}));
}
inline unsigned register_bits(uint64x2_t m) {
  return unsigned(vaddvq_u64(vandq_u64(m, uint64x2_t{1, 2})));
}
inline uint32x4_t register_and_not(uint32x4_t a, uint32x4_t b) {
  return vbicq_u32(a, b);
}
inline uint64x2_t register_and_not(uint64x2_t a, uint64x2_t b) {
  return vbicq_u64(a, b);
}
#else
inline unsigned register_bits(__m128 m) {
  return unsigned(_mm_movemask_ps(m));
}
inline unsigned register_bits(__m128d m) {
  return unsigned(_mm_movemask_pd(m));
}
inline __m128 register_and_not(__m128 a, __m128 b) {
  return _mm_andnot_ps(b, a);
}
inline __m128d register_and_not(__m128d a, __m128d b) {
  return _mm_andnot_pd(b, a);
}
#endif
#ifdef __AVX2__
inline unsigned register_bits(__m256 m) {
  return unsigned(_mm256_movemask_ps(m));
}
inline unsigned register_bits(__m256d m) {
  return unsigned(_mm256_movemask_pd(m));
}
inline __m256 register_and_not(__m256 a, __m256 b) {
  return _mm256_andnot_ps(b, a);
}
inline __m256d register_and_not(__m256d a, __m256d b) {
  return _mm256_andnot_pd(b, a);
}
#endif
template <std::integral Bits>
inline unsigned register_bits(Bits m) {
  return m;
}
template <std::integral Bits>
inline Bits register_and_not(Bits a, Bits b) {
  return static_cast<Bits>(a & ~b);
}

}  // namespace grelha::GRELHA_ISA
