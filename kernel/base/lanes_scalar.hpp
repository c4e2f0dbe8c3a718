#pragma once
// The functions of lanes.hpp for one float and one double.

#include <cstdint>

#include "kernel/base/isa.hpp"

namespace grelha::GRELHA_ISA {

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

inline float select(bool m, float a, float b) {
  return m ? a : b;
}
inline double select(bool m, double a, double b) {
  return m ? a : b;
}
inline float min(float a, float b) {
  return a < b ? a : b;
}  ///< b when either is NaN
inline float max(float a, float b) {
  return a > b ? a : b;
}  ///< b when either is NaN
inline double min(double a, double b) {
  return a < b ? a : b;
}
inline double max(double a, double b) {
  return a > b ? a : b;
}
inline float square_root(float a) {
  return __builtin_sqrtf(a);
}
inline double square_root(double a) {
  return __builtin_sqrt(a);
}
inline bool any(bool m) {
  return m;
}
inline bool none(bool m) {
  return !m;
}
inline unsigned bits(bool m) {
  return m;
}
inline bool mask_and(bool a, bool b) {
  return a & b;
}
inline bool mask_or(bool a, bool b) {
  return a | b;
}
inline bool and_not(bool a, bool b) {
  return a & !b;
}
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
inline std::int32_t to_int(float a) {
  return static_cast<std::int32_t>(a);
}
inline float to_float(std::int32_t a) {
  return static_cast<float>(a);
}
inline void load(const float* p, float& r) {
  r = *p;
}
inline void load(const double* p, double& r) {
  r = *p;
}
inline void store(float* p, float a) {
  *p = a;
}
inline void store(double* p, double a) {
  *p = a;
}
/// Stores selected lanes.
inline void store_selected(float* p, bool selected, float a) {
  if (selected)
    *p = a;
}
/// True if any lane is not 0.
inline bool any_set(std::uint32_t a) {
  return a != 0;
}
inline float small_to_float(std::uint32_t a) {
  return static_cast<float>(a);
}  ///< a < 2^24: exact
/// Least and greatest of the lanes; no lane is NaN.
inline float lane_min(float a) {
  return a;
}
inline float lane_max(float a) {
  return a;
}
/// Reduces the lanes of each of four registers and stores the results; reduces the results of many
/// such fours together in `all`. Take: TakeLeast or TakeMost.
template <class Take>
inline void reduce_lanes(const float (&of)[4], const Take& take, float (&to)[4], float (&all)[4]) {
  for (int i = 0; i < 4; ++i) {
    to[i] = of[i];
    all[i] = take(of[i], all[i]);
  }
}
/// The lanes in which a comparison of words holds.
inline bool mask_of(std::uint32_t a) {
  return a != 0;
}
/// Numbers and words at indices `at` < 2^31 of an array.
inline float floats_at(const float* from, std::uint32_t at) {
  return from[at];
}
inline std::uint32_t words_at(const std::uint32_t* from, std::uint32_t at) {
  return from[at];
}
/// Numbers without their fractions, of [0, 2^24).
inline float whole(float a) {
  return static_cast<float>(static_cast<std::int32_t>(a));
}
inline std::uint32_t to_words(float a) {
  return static_cast<std::uint32_t>(a);
}
/// Bytes at indices `at` of an array that has three more behind its last.
inline float bytes_at(const std::uint8_t* from, std::uint32_t at) {
  return from[at];
}
/// |a|.
inline float magnitude(float a) {
  return __builtin_fabsf(a);
}
inline double magnitude(double a) {
  return __builtin_fabs(a);
}
/// Doubles rounded to floats.
inline void store_narrow(float* p, double a) {
  *p = static_cast<float>(a);
}
/// The lanes with a bit in `lanes`, one behind another; as much as all would take may be written.
template <class T, class Vector>
inline void compress_store(T* to, const Vector& a, unsigned lanes) {
  T v[sizeof(Vector) / sizeof(T)];
  __builtin_memcpy(v, &a, sizeof v);
  for (unsigned left = lanes; left != 0; left &= left - 1)
    *to++ = v[__builtin_ctz(left)];
}

}  // namespace grelha::GRELHA_ISA
