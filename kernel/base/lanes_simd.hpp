#pragma once
// The functions of lanes.hpp for the registers of an instruction set that xsimd knows, and the few
// of its instructions that xsimd and the compiler's own vectors cannot say.

#include <concepts>
#include <type_traits>
#include <utility>

#include "kernel/base/isa.hpp"
#include "kernel/base/lanes_four.hpp"
#include "kernel/base/lanes_scalar.hpp"

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

#if GRELHA_ISA_NUMBER == 2
using Arch = xsimd::sse2;
using BlockArch = xsimd::sse2;
#elif GRELHA_ISA_NUMBER == 3
using Arch = xsimd::avx2;
using BlockArch = xsimd::avx2;
#elif GRELHA_ISA_NUMBER == 4
using Arch = xsimd::avx512bw;
using BlockArch = xsimd::avx2;
#else
using Arch = xsimd::neon64;
using BlockArch = xsimd::neon64;
#endif
using VFloat = xsimd::batch<float, Arch>;
using VDouble = xsimd::batch<double, Arch>;
using Block = xsimd::batch<float, BlockArch>;

template <class A>
using FloatBatch = xsimd::batch<float, A>;
template <class A>
using IntBatch = xsimd::batch<std::int32_t, A>;

template <std::floating_point T, class A>
struct LaneTraits<xsimd::batch<T, A>> {
  using Scalar = T;
  using Mask = xsimd::batch_bool<T, A>;
  using Int = IntBatch<A>;
  using Words = Vector<std::uint32_t, FloatBatch<A>::size>;
  static constexpr int kWidth = int(xsimd::batch<T, A>::size);
};
using LaneWords = Vector<std::uint32_t, VFloat::size>;

template <class To, class From>
[[gnu::always_inline]] inline To bits_as(const From& a) {
  return __builtin_bit_cast(To, a);
}
/// A register as a vector of its lanes.
template <class T, class A>
[[gnu::always_inline]] inline Vector<T, xsimd::batch<T, A>::size> vector(
    const xsimd::batch<T, A>& a) {
  return bits_as<Vector<T, xsimd::batch<T, A>::size>>(a);
}

// The constraint prefers these to xsimd's templates of the same names.

template <std::floating_point T, class A>
inline xsimd::batch<T, A> select(const xsimd::batch_bool<T, A>& m,
                                 const xsimd::batch<T, A>& a,
                                 const xsimd::batch<T, A>& b) {
  return xsimd::select(m, a, b);
}
/// The selects of the scalar twin, NaN and signed zeros included: minps and maxps are just these.
template <std::floating_point T, class A>
inline xsimd::batch<T, A> min(const xsimd::batch<T, A>& a, const xsimd::batch<T, A>& b) {
#if GRELHA_ISA_NUMBER == 5
  return xsimd::select(a < b, a, b);
#else
  return xsimd::min(a, b);
#endif
}
template <std::floating_point T, class A>
inline xsimd::batch<T, A> max(const xsimd::batch<T, A>& a, const xsimd::batch<T, A>& b) {
#if GRELHA_ISA_NUMBER == 5
  return xsimd::select(a > b, a, b);
#else
  return xsimd::max(a, b);
#endif
}
template <class T, class A>
inline xsimd::batch<T, A> square_root(const xsimd::batch<T, A>& a) {
#if GRELHA_ISA_NUMBER == 5
  if constexpr (sizeof(T) == 4)
    return vsqrtq_f32(a);  // xsimd's is not rounded once either
#endif
  return xsimd::sqrt(a);
}
template <class T, class A>
inline xsimd::batch<T, A> magnitude(const xsimd::batch<T, A>& a) {
  return xsimd::abs(a);
}
template <class T, class A>
inline xsimd::batch_bool<T, A> mask_and(const xsimd::batch_bool<T, A>& a,
                                        const xsimd::batch_bool<T, A>& b) {
  return a & b;
}
template <class T, class A>
inline xsimd::batch_bool<T, A> mask_or(const xsimd::batch_bool<T, A>& a,
                                       const xsimd::batch_bool<T, A>& b) {
  return a | b;
}
template <class T, class A>
inline unsigned bits(const xsimd::batch_bool<T, A>& m) {
  return register_bits(m.data);
}
/// xsimd's own is a and not b on some instruction sets, not a and b on others.
template <class T, class A>
inline xsimd::batch_bool<T, A> and_not(const xsimd::batch_bool<T, A>& a,
                                       const xsimd::batch_bool<T, A>& b) {
  return xsimd::batch_bool<T, A>(register_and_not(a.data, b.data));
}
template <std::floating_point T, class A>
inline bool any(const xsimd::batch_bool<T, A>& m) {
  return bits(m) != 0;
}
template <std::floating_point T, class A>
inline bool none(const xsimd::batch_bool<T, A>& m) {
  return bits(m) == 0;
}

// xsimd's own cast takes a type of batches in older versions, one of lanes in newer ones.
template <class A>
inline IntBatch<A> float_bits(const FloatBatch<A>& a) {
  return bits_as<IntBatch<A>>(a);
}
template <class A>
inline FloatBatch<A> bits_float(const IntBatch<A>& a) {
  return bits_as<FloatBatch<A>>(a);
}
template <class A>
inline FloatBatch<A> to_float(const IntBatch<A>& a) {
  return xsimd::to_float(a);
}
template <class A>
inline IntBatch<A> to_int(const FloatBatch<A>& a) {
  return xsimd::to_int(a);
}
template <class A>
inline FloatBatch<A> whole(const FloatBatch<A>& a) {
  return xsimd::to_float(xsimd::to_int(a));
}
inline LaneWords to_words(const VFloat& a) {
  return bits_as<LaneWords>(xsimd::to_int(a));
}
inline VFloat small_to_float(const LaneWords& a) {
  return xsimd::to_float(bits_as<IntBatch<Arch>>(a));
}
template <std::floating_point T, class A>
inline void load(const T* p, xsimd::batch<T, A>& r) {
  r = xsimd::batch<T, A>::load_unaligned(p);
}
template <class A>
inline void store(float* p, const FloatBatch<A>& a) {
  a.store_unaligned(p);
}
inline void store(double* p, const VDouble& a) {
  a.store_unaligned(p);
}

/// Stores selected lanes.
[[gnu::always_inline]] inline void store_selected(float* p,
                                                  const xsimd::batch_bool<float, Arch>& m,
                                                  const VFloat& a) {
#if GRELHA_ISA_NUMBER == 4
  _mm512_mask_storeu_ps(p, m, a);
#else
  store(p, select(m, a, VFloat::load_unaligned(p)));
#endif
}

/// Of words that are 0 or all ones.
inline xsimd::batch_bool<float, Arch> mask_of(const LaneWords& a) {
#if GRELHA_ISA_NUMBER == 4
  return xsimd::batch_bool<float, Arch>(_mm512_movepi32_mask(bits_as<__m512i>(a)));
#else
  return bits_as<xsimd::batch_bool<float, Arch>>(a);
#endif
}
inline bool any_set(const LaneWords& a) {
#if GRELHA_ISA_NUMBER == 4
  return _mm512_test_epi32_mask(bits_as<__m512i>(a), bits_as<__m512i>(a)) != 0;
#elif GRELHA_ISA_NUMBER == 3
  return _mm256_testz_si256(bits_as<__m256i>(a), bits_as<__m256i>(a)) == 0;
#else
  return any(mask_of(LaneWords(a != 0)));
#endif
}

/// Words at addresses `at` * scale bytes from `from`. xsimd's own gather is a loop in Debian 12.
template <int scale>
[[gnu::always_inline]] inline LaneWords gathered(const void* from, const LaneWords& at) {
#if GRELHA_ISA_NUMBER == 4
  return bits_as<LaneWords>(_mm512_i32gather_epi32(bits_as<__m512i>(at), from, scale));
#elif GRELHA_ISA_NUMBER == 3
  const auto* words = static_cast<const int*>(from);
  return bits_as<LaneWords>(_mm256_i32gather_epi32(words, bits_as<__m256i>(at), scale));
#else
  LaneWords r;
  for (std::size_t i = 0; i < VFloat::size; ++i) {
    std::uint32_t word;
    __builtin_memcpy(
        &word, static_cast<const char*>(from) + std::size_t{scale} * at[i], sizeof word);
    r[i] = word;
  }
  return r;
#endif
}
inline VFloat floats_at(const float* from, const LaneWords& at) {
  return bits_as<VFloat>(gathered<4>(from, at));
}
inline LaneWords words_at(const std::uint32_t* from, const LaneWords& at) {
  return gathered<4>(from, at);
}
inline VFloat bytes_at(const std::uint8_t* from, const LaneWords& at) {
  return small_to_float(gathered<1>(from, at) & 255u);
}

/// Half h of a register's lanes.
template <int h, class V>
[[gnu::always_inline]] inline auto half(const V& a) {
  constexpr std::size_t n = sizeof(V) / sizeof a[0] / 2;
  return [&]<std::size_t... i>(std::index_sequence<i...>) {
    return __builtin_shufflevector(a, a, (h * n + i)...);
  }
  (std::make_index_sequence<n>());
}
/// Two places of `a`, then two of `b`, of each four lanes; `places` as of _mm_shuffle_ps.
template <unsigned places, class V>
[[gnu::always_inline]] inline V shuffled(const V& a, const V& b) {
  constexpr auto lane = [](std::size_t i) {
    return i / 4 * 4 + (places >> 2 * (i % 4) & 3) + (i % 4 < 2 ? 0 : VFloat::size);
  };
  return [&]<std::size_t... i>(std::index_sequence<i...>) {
    return __builtin_shufflevector(a, b, lane(i)...);
  }
  (std::make_index_sequence<VFloat::size>());
}
/// Takes lanes four apart together, until four are left.
template <class V, class Take>
[[gnu::always_inline]] inline Four folded(const V& a, const Take& take) {
  if constexpr (sizeof(V) == sizeof(Four))
    return a;
  else
    return folded(take(half<0>(a), half<1>(a)), take);
}
inline float lane_min(const VFloat& a) {
  return reduce_min(folded(vector(a), TakeLeast{}));
}
inline float lane_max(const VFloat& a) {
  return reduce_max(folded(vector(a), TakeMost{}));
}
template <class Take>
[[gnu::always_inline]] inline void reduce_lanes(const VFloat (&of)[4],
                                                const Take& take,
                                                float (&to)[4],
                                                float (&all)[4]) {
  const auto a = vector(of[0]), b = vector(of[1]), c = vector(of[2]), d = vector(of[3]);
  const auto ab = take(shuffled<0x44>(a, b), shuffled<0xEE>(a, b));
  const auto cd = take(shuffled<0x44>(c, d), shuffled<0xEE>(c, d));
  const Four four = folded(take(shuffled<0x88>(ab, cd), shuffled<0xDD>(ab, cd)), take);
  __builtin_memcpy(to, &four, sizeof four);
  Four both;
  __builtin_memcpy(&both, all, sizeof both);
  both = take(four, both);
  __builtin_memcpy(all, &both, sizeof both);
}

/// As many floats as there are doubles in a register.
using NarrowFloats = Vector<float, VDouble::size>;
// __builtin_convertvector of GCC 12 would convert two by two.
[[gnu::always_inline]] inline VDouble widened(const NarrowFloats& a) {
#if GRELHA_ISA_NUMBER == 4
  return VDouble(_mm512_cvtps_pd(bits_as<__m256>(a)));
#elif GRELHA_ISA_NUMBER == 3
  return VDouble(_mm256_cvtps_pd(bits_as<__m128>(a)));
#elif GRELHA_ISA_NUMBER == 5
  return VDouble(vcvt_f64_f32(bits_as<float32x2_t>(a)));
#else
  return VDouble(_mm_cvtps_pd(bits_as<__m128>(__builtin_shufflevector(a, a, 0, 1, 0, 1))));
#endif
}
[[gnu::always_inline]] inline NarrowFloats narrowed(const VDouble& a) {
#if GRELHA_ISA_NUMBER == 4
  return bits_as<NarrowFloats>(_mm512_cvtpd_ps(a.data));
#elif GRELHA_ISA_NUMBER == 3
  return bits_as<NarrowFloats>(_mm256_cvtpd_ps(a.data));
#elif GRELHA_ISA_NUMBER == 5
  return bits_as<NarrowFloats>(vcvt_f32_f64(a.data));
#else
  return half<0>(bits_as<Four>(_mm_cvtpd_ps(a.data)));
#endif
}
inline void load_double(const float* p, VDouble& r) {
  NarrowFloats floats;
  __builtin_memcpy(&floats, p, sizeof floats);
  r = widened(floats);
}
inline void store_narrow(float* p, const VDouble& a) {
  const NarrowFloats floats = narrowed(a);
  __builtin_memcpy(p, &floats, sizeof floats);
}
template <int i, class A>
inline VDouble part_to_double(const FloatBatch<A>& a) {
  if constexpr (FloatBatch<A>::size == VDouble::size)
    return widened(vector(a));
  else
    return widened(half<i>(vector(a)));
}
inline VFloat narrow_parts(const VDouble (&part)[2]) {
  return [&]<std::size_t... i>(std::index_sequence<i...>) {
    return bits_as<VFloat>(__builtin_shufflevector(narrowed(part[0]), narrowed(part[1]), i...));
  }
  (std::make_index_sequence<VFloat::size>());
}
#if GRELHA_ISA_NUMBER == 4
inline Block narrow_parts(const VDouble (&part)[1]) {
  return bits_as<Block>(narrowed(part[0]));
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
template <class T, class V>
requires(sizeof(V) == 64) inline void compress_store(T* to, const V& a, unsigned lanes) {
  const __m512i v = bits_as<__m512i>(a);
  _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(lanes), v));
}
template <class T, class V>
requires(sizeof(V) == 32) inline void compress_store(T* to, const V& a, unsigned lanes) {
  const __m256i v = _mm256_maskz_compress_epi32(static_cast<__mmask8>(lanes), bits_as<__m256i>(a));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), v);
}
#elif GRELHA_ISA_NUMBER == 3
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

template <class T, class V>
requires(sizeof(V) == 32) inline void compress_store(T* to, const V& a, unsigned lanes) {
  const __m256i order =
      _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(kSetBits.row + lanes)));
  const __m256i v = _mm256_permutevar8x32_epi32(bits_as<__m256i>(a), order);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), v);
}
#endif

}  // namespace grelha::GRELHA_ISA
