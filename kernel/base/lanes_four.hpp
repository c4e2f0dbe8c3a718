#pragma once
// The compiler's own vectors, which exist on every processor and convert, shuffle, compare and
// multiply there. Four floats side by side hold x, y and z of one ray, and one more.

#include <cstddef>
#include <cstdint>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include "kernel/base/isa.hpp"

namespace grelha::GRELHA_ISA {

template <class T, std::size_t count>
struct VectorOf {
  typedef T Type __attribute__((vector_size(sizeof(T) * count)));  // GCC wants no `using` here
};
template <class T, std::size_t count>
using Vector = typename VectorOf<T, count>::Type;

using Four = Vector<float, 4>;
using FourInts = Vector<std::int32_t, 4>;  ///< as a mask: 0 or -1

inline Four four(float x) {
  return Four{x, x, x, x};
}
inline Four four(const float (&xyz)[3], float rest) {
  return Four{xyz[0], xyz[1], xyz[2], rest};
}
inline Four four(const float (&xyz)[3][1], float rest) {
  return Four{*xyz[0], *xyz[1], *xyz[2], rest};
}
inline void store(float (&to)[4][1], const Four& a) {
  __builtin_memcpy(to, &a, sizeof a);
}
inline void store(std::uint32_t (&to)[4][1], const FourInts& a) {
  __builtin_memcpy(to, &a, sizeof a);
}

/// As min and max of lanes: of NaN and anything the second.
struct TakeLeast {
  template <class V>
  V operator()(const V& a, const V& b) const {
    return a < b ? a : b;
  }
};
struct TakeMost {
  template <class V>
  V operator()(const V& a, const V& b) const {
    return a > b ? a : b;
  }
};
inline Four min(const Four& a, const Four& b) {
  return TakeLeast{}(a, b);
}
inline Four max(const Four& a, const Four& b) {
  return TakeMost{}(a, b);
}
inline FourInts min(const FourInts& a, const FourInts& b) {
  return TakeLeast{}(a, b);
}
inline FourInts max(const FourInts& a, const FourInts& b) {
  return TakeMost{}(a, b);
}
inline Four magnitude(const Four& a) {
  return reinterpret_cast<Four>(reinterpret_cast<FourInts>(a) & 0x7FFFFFFF);
}

inline Four select(const FourInts& mask, const Four& a, const Four& b) {
  return mask ? a : b;
}

/// Without fractions.
inline FourInts to_ints(const Four& a) {
  return __builtin_convertvector(a, FourInts);
}
inline Four to_floats(const FourInts& a) {
  return __builtin_convertvector(a, Four);
}

/// Elements of `a` that a mask selects; 0 elsewhere.
inline Four masked(const FourInts& mask, const Four& a) {
  return reinterpret_cast<Four>(reinterpret_cast<FourInts>(a) & mask);
}

/// Combines all four elements, two by two; every element holds the result.
template <class Vector, class Take>
inline Vector together(const Vector& a, const Take& take) {
  const Vector b = take(a, __builtin_shufflevector(a, a, 2, 3, 0, 1));
  return take(b, __builtin_shufflevector(b, b, 1, 0, 3, 2));
}
inline std::int32_t sum(const FourInts& a) {
  return together(a, [](const FourInts& x, const FourInts& y) { return x + y; })[0];
}
/// The bits of all.
inline FourInts any_of(const FourInts& a) {
  return together(a, [](const FourInts& x, const FourInts& y) { return x | y; });
}
/// A bit for each element of a mask.
inline unsigned bits(const FourInts& mask) {
#ifdef __SSE2__
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(mask)));
#else
  return static_cast<unsigned>(any_of(mask & FourInts{1, 2, 4, 8})[0]);
#endif
}
/// True if any element of a mask is set.
inline bool any(const FourInts& mask) {
  return bits(mask) != 0;
}
inline float reduce_min(const Four& a) {
  return together(a, TakeLeast{})[0];
}
inline float reduce_max(const Four& a) {
  return together(a, TakeMost{})[0];
}

}  // namespace grelha::GRELHA_ISA
