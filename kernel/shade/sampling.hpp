#pragma once
// Sample positions as pure functions of (seed, pixel, sample, dimension): no state, so threads,
// packets and the order of work cannot change a picture. Integer arithmetic and one exact
// conversion: the same bits everywhere.

#include <cstdint>

#include "kernel/scene/shading_view.hpp"
#include "kernel/base/vec3.hpp"

namespace grelha::GRELHA_ISA {

// Everything is written once over a word: one std::uint32_t, or VUint, one sample a lane.

/// Avalanche of 32 bits (C. Wellons' lowbias32).
template <class Word>
inline Word scatter(Word x) {
  x ^= x >> 16;
  x *= 0x7FEB352Du;
  x ^= x >> 15;
  x *= 0x846CA68Bu;
  return x ^ x >> 16;
}
template <class A, class B>
inline auto scatter(A a, B b) {
  return scatter(a ^ (scatter(b) + 0x9E3779B9u + (a << 6) + (a >> 2)));
}

/// [0, 1) from the upper 24 bits: exact, never 1.
template <class Word>
inline auto unit_float(Word x) {
  const auto whole = small_to_float(x >> 8);
  return whole * decltype(small_to_float(x))(1.f / 16777216);
}

template <class Word>
constexpr Word reversed(Word x) {
  x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
  x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
  x = (x >> 4 & 0x0F0F0F0Fu) | (x & 0x0F0F0F0Fu) << 4;
  x = (x >> 8 & 0x00FF00FFu) | (x & 0x00FF00FFu) << 8;
  return x >> 16 | x << 16;
}

/// Owen scrambling of a number written backwards, its first binary place lowest: a hash in which
/// higher bits depend on lower ones alone. Laine & Karras 2011; Burley, "Practical Hash-based Owen
/// Scrambling", JCGT 9(4), 2020, with Vegdahl's constants.
template <class Word>
inline Word owen_hash(Word x, Word seed) {
  x ^= x * 0x3D20ADEAu;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526C56u;
  x ^= x * 0x53A22864u;
  return x;
}

inline constexpr int kSobolDimensions = 8;

/// A primitive polynomial over two elements, and what its recurrence begins with (Joe & Kuo 2008,
/// new-joe-kuo-6.21201).
struct SobolPolynomial {
  unsigned degree, coefficients;
  std::uint32_t first[5];
};
inline constexpr SobolPolynomial kSobolPolynomials[kSobolDimensions] = {
    {0, 0, {}},
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
};

/// Direction numbers of Sobol's sequence for eight dimensions, written backwards.
struct SobolMatrices {
  std::uint32_t column[kSobolDimensions][32];

  constexpr SobolMatrices() : column{} {
    for (int d = 0; d < kSobolDimensions; ++d) {
      for (unsigned i = 0; i < 32; ++i)
        column[d][i] = direction(kSobolPolynomials[d], column[d], i);
      for (std::uint32_t& c : column[d])
        c = reversed(c);
    }
  }

  /// Computes the i-th direction number from those before it.
  static constexpr std::uint32_t direction(const SobolPolynomial& p,
                                           const std::uint32_t* before,
                                           unsigned i) {
    const unsigned s = p.degree;
    if (s == 0)
      return 1u << (31 - i);
    if (i < s)
      return p.first[i] << (31 - i);
    std::uint32_t v = before[i - s] ^ (before[i - s] >> s);
    for (unsigned k = 1; k < s; ++k)
      if (p.coefficients >> (s - 1 - k) & 1u)
        v ^= before[i - k];
    return v;
  }
};
inline constexpr SobolMatrices kSobol;

/// Point `index` of one dimension of Sobol's sequence: 32 binary places, written backwards.
template <class Word>
inline Word sobol_points(Word index, int dimension) {
  if (dimension == 0)
    return index;
  // place k sums the index bits i for which C(i, k) is odd: those whose number i has all bits of k
  if (dimension == 1) {
    index ^= index >> 16;
    index ^= index >> 8 & 0x00FF00FFu;
    index ^= index >> 4 & 0x0F0F0F0Fu;
    index ^= index >> 2 & 0x33333333u;
    return index ^ (index >> 1 & 0x55555555u);
  }
  Word x{};
  for (const std::uint32_t* c = kSobol.column[dimension]; any_set(index); index >>= 1)
    x ^= *c++ & (0u - (index & 1u));
  return x;
}

/// Sample `index` in dimension `dimension` of the sequence that `seed` names, as 32 binary places:
/// one Owen-scrambled Sobol sequence in up to eight dimensions. Different seeds are independent.
template <class Word>
inline Word sobol_bits(Word seed, Word index, int dimension) {
  return reversed(owen_hash(sobol_points(index, dimension),
                            scatter(seed, static_cast<std::uint32_t>(dimension))));
}
inline float sobol_sample(std::uint32_t seed, std::uint32_t index, int dimension) {
  return unit_float(sobol_bits(seed, index, dimension));
}

/// A permutation of [0, w], w one less than a power of two.
[[gnu::always_inline]] inline std::uint32_t permute_round(std::uint32_t i,
                                                          std::uint32_t w,
                                                          std::uint32_t seed) {
  i ^= seed;
  i *= 0xE170893Du;
  i ^= seed >> 16;
  i ^= (i & w) >> 4;
  i ^= seed >> 8;
  i *= 0x0929EB3Fu;
  i ^= seed >> 23;
  i ^= (i & w) >> 1;
  i *= 1 | seed >> 27;
  i *= 0x6935FA69u;
  i ^= (i & w) >> 11;
  i *= 0x74DCB303u;
  i ^= (i & w) >> 2;
  i *= 0x9E501CC3u;
  i ^= (i & w) >> 2;
  i *= 0xC860A3DFu;
  i &= w;
  return i ^ i >> 5;
}

/// Position of i after a random permutation of [0, n): Kensler, "Correlated Multi-Jittered
/// Sampling", 2013.
inline std::uint32_t permute(std::uint32_t i, std::uint32_t n, std::uint32_t seed) {
  std::uint32_t w = n - 1;
  w |= w >> 1;
  w |= w >> 2;
  w |= w >> 4;
  w |= w >> 8;
  w |= w >> 16;
  do {
    i = permute_round(i, w, seed);
  } while (i >= n);
  return (i + seed) % n;
}

template <class Real>
struct PairOf {
  Real u, v;
};
using Pair = PairOf<float>;

/// Cells of a grid, one a lane.
template <class Real>
struct LaneCells {
  float column[kWidth<Real>], row[kWidth<Real>];
};

/// The cells in turn; where `shuffled` is not 0, in an order of their own. Found lane by lane: by
/// divisions, and a loop of no known length.
template <class Real>
[[gnu::always_inline]] inline LaneCells<Real> cells_in_turn(Words<Real> seed,
                                                            Words<Real> index,
                                                            const Strata& strata,
                                                            Words<Real> shuffled) {
  const std::uint32_t cells = strata.columns * strata.rows;
  std::uint32_t i[kWidth<Real>], own[kWidth<Real>], order[kWidth<Real>];
  store_words(i, index);
  store_words(own, scatter(seed, 0x51ED270Bu));
  store_words(order, shuffled);
  LaneCells<Real> found;
  for (int k = 0; k < kWidth<Real>; ++k) {
    std::uint32_t cell = i[k] % cells;
    if (order[k] != 0)
      cell = permute(cell, cells, own[k]);
    found.column[k] = static_cast<float>(cell % strata.columns);
    found.row[k] = static_cast<float>(cell / strata.columns);
  }
  return found;
}

/// A random point of the unit square.
template <class Word>
[[gnu::always_inline]] inline auto random_pair(Word seed, Word index) {
  using Real = decltype(unit_float(index));
  return PairOf<Real>{unit_float(scatter(seed, index + index)),
                      unit_float(scatter(seed, index + index + 1u))};
}

/// A point in each cell in turn, see cells_in_turn().
template <class Real>
inline PairOf<Real> jittered(Words<Real> seed,
                             Words<Real> index,
                             const Strata& strata,
                             Words<Real> shuffled) {
  const LaneCells<Real> cell = cells_in_turn<Real>(seed, index, strata, shuffled);
  const PairOf<Real> in = random_pair(seed, index);
  const Real columns(static_cast<float>(strata.columns));
  const Real rows(static_cast<float>(strata.rows));
  return {(load<Real>(cell.column) + in.u) / columns, (load<Real>(cell.row) + in.v) / rows};
}

/// Two dimensions of Sobol's sequence: of the joint one, which `base` names, where `key` is 0; else
/// the first two of `own`, in an order of its own.
template <class Word>
[[gnu::always_inline]] inline auto sobol_pair(
    Word base, Word own, Word index, int dimension, Word key) {
  using Real = decltype(unit_float(index));
  const auto joint = key == 0u;
  Word u{}, v{};
  if (any_set(Word(joint))) {
    u = sobol_bits(base, index, dimension);
    v = sobol_bits(base, index, dimension + 1);
  }
  if (any_set(key)) {
    const Word at = reversed(owen_hash(reversed(index), scatter(own, 0x68E31DA4u)));
    u = joint ? u : sobol_bits(own, at, 0);
    v = joint ? v : sobol_bits(own, at, 1);
  }
  return PairOf<Real>{unit_float(u), unit_float(v)};
}

/// Two numbers in [0, 1): sample `index` of a pixel in dimensions `dimension` and the next. `key`
/// tells apart the uses of a pair along a path (bounces, lights). 0 is the joint sequence; any
/// other is a sequence of its own, in an order of its own. The same points in the same order again
/// would pair samples the same way in every pixel.
template <class Real>
inline PairOf<Real> sample_pairs(const SamplePlan& plan,
                                 Words<Real> pixel,
                                 Words<Real> index,
                                 int dimension,
                                 Words<Real> key,
                                 const Strata& strata) {
  using Word = Words<Real>;
  const auto use = static_cast<std::uint32_t>(dimension);
  const bool blue = plan.kind == SamplePlan::kBlue;  // pixels draw runs of one sequence
  const Word base = blue ? Word{} + scatter(plan.seed) : scatter(plan.seed, pixel);
  const Word own = scatter(base, scatter(key, use));
  if (plan.kind == SamplePlan::kJitter)
    return jittered<Real>(own, index, strata, key | use);
  if (plan.kind == SamplePlan::kRandom)
    return random_pair(own, index);
  const Word at = blue ? words_at(plan.places, pixel) * strata.count + index : index;
  return sobol_pair(base, own, at, dimension, key);
}
inline Pair sample_pair(const SamplePlan& plan,
                        std::uint32_t pixel,
                        std::uint32_t index,
                        int dimension,
                        std::uint32_t key,
                        const Strata& strata) {
  return sample_pairs<float>(plan, pixel, index, dimension, key, strata);
}

/// Sine of x in [-pi/4, pi/4], from x and its square.
template <class Real>
[[gnu::always_inline]] inline Real sine(const Real& x, const Real& xx) {
  const Real one(1);
  const Real third(1.f / 6), fifth(1.f / 120), seventh(1.f / 5040);
  return x * (one - xx * (third - xx * (fifth - xx * seventh)));
}

/// Cosine of x in [-pi/4, pi/4], from its square.
template <class Real>
[[gnu::always_inline]] inline Real cosine(const Real& xx) {
  const Real one(1);
  const Real second(.5f), fourth(1.f / 24), sixth(1.f / 720), eighth(1.f / 40320);
  return one - xx * (second - xx * (fourth - xx * (sixth - xx * eighth)));
}

/// A point of the unit disc for a point of the unit square, areas in proportion (Shirley & Chiu
/// 1997). Sine and cosine are polynomials (error below 4e-7 on [-pi/4, pi/4]), since libm's last
/// bit depends on the machine.
template <class Real>
inline PairOf<Real> disc_point(const PairOf<Real>& square) {
  const Real o(0), one(1), two(2), quarter_pi(0.78539816f);
  const Real a = two * square.u - one;
  const Real b = two * square.v - one;
  const Mask<Real> wide = a * a > b * b;
  const Real r = select(wide, a, b);
  const Real x = quarter_pi * (select(wide, b, a) / r);
  const Real s = sine(x, x * x);
  const Real c = cosine(x * x);
  const Mask<Real> centre = mask_and(a == o, b == o);  // where x is 0 / 0
  return {select(centre, o, r * select(wide, c, s)), select(centre, o, r * select(wide, s, c))};
}

}  // namespace grelha::GRELHA_ISA
