#pragma once
// Sample positions as pure functions of (seed, pixel, sample, dimension): no state, so threads, packets and the order of work
// cannot change a picture. Integer arithmetic and one exact conversion: the same bits everywhere.

#include <cstdint>

#include "kernel/shading_view.hpp"
#include "kernel/vec3.hpp"

namespace grelha::GRELHA_ISA {

/// Avalanche of 32 bits (C. Wellons' lowbias32).
inline std::uint32_t scatter(std::uint32_t x) {
  x ^= x >> 16, x *= 0x7FEB352Du;
  x ^= x >> 15, x *= 0x846CA68Bu;
  return x ^ x >> 16;
}
inline std::uint32_t scatter(std::uint32_t a, std::uint32_t b) { return scatter(a ^ (scatter(b) + 0x9E3779B9u + (a << 6) + (a >> 2))); }

/// [0, 1) from the upper 24 bits: exact, never 1.
inline float unit_float(std::uint32_t x) { return static_cast<float>(x >> 8) * (1.f / 16777216); }

inline std::uint32_t reversed(std::uint32_t x) {
  x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
  x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
  x = (x >> 4 & 0x0F0F0F0Fu) | (x & 0x0F0F0F0Fu) << 4;
  return __builtin_bswap32(x);
}

/// Owen scrambling by a hash in which higher bits depend on lower ones alone, applied to reversed bits.
/// Laine & Karras 2011; Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020, with Vegdahl's constants.
inline std::uint32_t owen_scrambled(std::uint32_t x, std::uint32_t seed) {
  x = reversed(x);
  x ^= x * 0x3D20ADEAu;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526C56u;
  x ^= x * 0x53A22864u;
  return reversed(x);
}

inline constexpr int kSobolDimensions = 8;

/// Direction numbers of Sobol's sequence for eight dimensions (Joe & Kuo 2008, new-joe-kuo-6.21201).
struct SobolMatrices {
  std::uint32_t column[kSobolDimensions][32];
  constexpr SobolMatrices() : column{} {
    constexpr unsigned degree[kSobolDimensions] = {0, 1, 2, 3, 3, 4, 4, 5};
    constexpr unsigned polynomial[kSobolDimensions] = {0, 0, 1, 1, 2, 1, 4, 2};
    constexpr std::uint32_t first[kSobolDimensions][5] = {{}, {1}, {1, 3}, {1, 3, 1}, {1, 1, 1}, {1, 1, 3, 3}, {1, 3, 5, 13}, {1, 1, 5, 5, 17}};
    for (int d = 0; d < kSobolDimensions; ++d)
      for (unsigned i = 0; i < 32; ++i) {
        const unsigned s = degree[d];
        if (s == 0) {
          column[d][i] = 1u << (31 - i);
        } else if (i < s) {
          column[d][i] = first[d][i] << (31 - i);
        } else {
          std::uint32_t v = column[d][i - s] ^ (column[d][i - s] >> s);
          for (unsigned k = 1; k < s; ++k)
            if (polynomial[d] >> (s - 1 - k) & 1u) v ^= column[d][i - k];
          column[d][i] = v;
        }
      }
  }
};
inline constexpr SobolMatrices kSobol;

/// Point `index` of one dimension of Sobol's sequence, as 32 binary places.
inline std::uint32_t sobol_bits(std::uint32_t index, int dimension) {
  std::uint32_t x = 0;
  for (; index != 0; index &= index - 1) x ^= kSobol.column[dimension][__builtin_ctz(index)];
  return x;
}

/// Sample `index` in dimension `dimension` of the sequence that `seed` names: one Owen-scrambled Sobol sequence in up to
/// eight dimensions. Different seeds are independent.
inline float sobol_sample(std::uint32_t seed, std::uint32_t index, int dimension) {
  return unit_float(owen_scrambled(sobol_bits(index, dimension), scatter(seed, static_cast<std::uint32_t>(dimension))));
}

/// Place of i after a random permutation of [0, n): Kensler, "Correlated Multi-Jittered Sampling", 2013.
inline std::uint32_t permuted(std::uint32_t i, std::uint32_t n, std::uint32_t seed) {
  std::uint32_t w = n - 1;
  w |= w >> 1, w |= w >> 2, w |= w >> 4, w |= w >> 8, w |= w >> 16;
  do {
    i ^= seed, i *= 0xE170893Du;
    i ^= seed >> 16, i ^= (i & w) >> 4;
    i ^= seed >> 8, i *= 0x0929EB3Fu;
    i ^= seed >> 23, i ^= (i & w) >> 1, i *= 1 | seed >> 27;
    i *= 0x6935FA69u, i ^= (i & w) >> 11, i *= 0x74DCB303u;
    i ^= (i & w) >> 2, i *= 0x9E501CC3u, i ^= (i & w) >> 2, i *= 0xC860A3DFu;
    i &= w, i ^= i >> 5;
  } while (i >= n);
  return (i + seed) % n;
}

struct Pair {
  float u, v;
};

inline Pair jittered(std::uint32_t seed, std::uint32_t index, const Strata& strata, bool shuffled) {
  const std::uint32_t cells = strata.columns * strata.rows;
  const std::uint32_t cell = shuffled ? permuted(index % cells, cells, scatter(seed, 0x51ED270Bu)) : index % cells;
  const float x = unit_float(scatter(seed, 2 * index)), y = unit_float(scatter(seed, 2 * index + 1));
  return {(static_cast<float>(cell % strata.columns) + x) / static_cast<float>(strata.columns),
          (static_cast<float>(cell / strata.columns) + y) / static_cast<float>(strata.rows)};
}

/// Two numbers in [0, 1): sample `index` of a pixel in dimensions `dimension` and the next. `key` tells apart the uses of a
/// pair along a path (bounces, lights): 0 is the joint sequence; any other is a sequence of its own, in an order of its own,
/// since the same points in the same order again would pair samples the same way in every pixel.
inline Pair sample_pair(const SamplePlan& plan, std::uint32_t pixel, std::uint32_t index, int dimension, std::uint32_t key,
                        const Strata& strata) {
  const std::uint32_t base = scatter(plan.seed, pixel);
  if (plan.kind == SamplePlan::kSobol) {
    if (key == 0) return {sobol_sample(base, index, dimension), sobol_sample(base, index, dimension + 1)};
    const std::uint32_t own = scatter(base, scatter(key, static_cast<std::uint32_t>(dimension)));
    const std::uint32_t at = owen_scrambled(index, scatter(own, 0x68E31DA4u));
    return {sobol_sample(own, at, 0), sobol_sample(own, at, 1)};
  }
  const std::uint32_t own = scatter(base, scatter(key, static_cast<std::uint32_t>(dimension)));
  if (plan.kind == SamplePlan::kJitter) return jittered(own, index, strata, dimension != 0 || key != 0);
  return {unit_float(scatter(own, 2 * index)), unit_float(scatter(own, 2 * index + 1))};
}

/// A point of the unit disc for a point of the unit square, areas in proportion: Shirley & Chiu 1997, with sine and cosine as
/// polynomials (error below 4e-7 on [-pi/4, pi/4]), since libm's last bit depends on the machine.
inline Pair disc_point(const Pair& square) {
  const float a = 2 * square.u - 1, b = 2 * square.v - 1;
  if (a == 0 && b == 0) return {0, 0};
  const bool wide = a * a > b * b;
  const float r = wide ? a : b, x = 0.78539816f * (wide ? b / a : a / b), xx = x * x;
  const float s = x * (1 - xx * (1.f / 6 - xx * (1.f / 120 - xx * (1.f / 5040))));
  const float c = 1 - xx * (.5f - xx * (1.f / 24 - xx * (1.f / 720 - xx * (1.f / 40320))));
  return wide ? Pair{r * c, r * s} : Pair{r * s, r * c};
}

}  // namespace grelha::GRELHA_ISA
