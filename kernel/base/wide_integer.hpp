#pragma once
// Integers of 128 bits, for exact products of three lengths that are no wider apart than floats of
// one mesh are.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>

#include "kernel/base/expansion.hpp"

namespace grelha {

__extension__ using Int128 = __int128;

/// Three numbers as integers times a power of two.
struct IntegerVector {
  std::int64_t at[3];
};

/// Divides vectors by the power of two that leaves them less than 2^bits, and keeps it. Returns
/// false if that leaves a number that is no integer, if all are 0, and of 2^100 or more.
template <std::size_t kCount>
bool to_integers(const double (&v)[kCount][3],
                 int bits,
                 IntegerVector (&integers)[kCount],
                 double& unit) {
  double largest = 0;
  for (const auto& p : v)
    for (const double x : p)
      largest = std::abs(x) > largest ? std::abs(x) : largest;
  if (!(largest > 0 && largest < 0x1p100))
    return false;
  std::uint64_t field;  // of the exponent; `largest` is no denormal
  std::memcpy(&field, &largest, sizeof field);
  field = ((field >> 52) + 1 - static_cast<std::uint64_t>(bits)) << 52;
  std::memcpy(&unit, &field, sizeof unit);
  const double inverse = 1 / unit;
  bool whole = true;
  for (std::size_t i = 0; i < kCount; ++i)
    for (std::size_t a = 0; a < 3; ++a) {
      const double scaled = v[i][a] * inverse;
      whole = whole && std::trunc(scaled) == scaled;  // no NaN
      integers[i].at[a] = whole ? static_cast<std::int64_t>(scaled) : 0;
    }
  return whole;
}

struct WideIntegerVector {
  Int128 x, y, z;
};
inline WideIntegerVector cross(const IntegerVector& p, const IntegerVector& q) {
  const auto& a = p.at;
  const auto& b = q.at;
  return {Int128{a[1]} * b[2] - Int128{a[2]} * b[1],
          Int128{a[2]} * b[0] - Int128{a[0]} * b[2],
          Int128{a[0]} * b[1] - Int128{a[1]} * b[0]};
}
inline Int128 dot(const WideIntegerVector& p, const IntegerVector& q) {
  return p.x * q.at[0] + p.y * q.at[1] + p.z * q.at[2];
}
inline int sign_of(Int128 n) {
  return n < 0 ? -1 : n > 0 ? 1 : 0;
}
/// The number, within 2^-51 of itself.
inline double double_of(Int128 n) {
  const Int128 size = n < 0 ? -n : n;
  const double d = static_cast<double>(static_cast<std::int64_t>(size >> 64)) * 0x1p64 +
                   static_cast<double>(static_cast<std::uint64_t>(size));
  return n < 0 ? -d : d;
}
/// The sign of a b - c d.
inline int compare_products(Int128 a, Int128 b, Int128 c, Int128 d) {
  using Word = std::uint64_t;
  __extension__ using Wide = unsigned __int128;
  struct Product {
    Wide high, low;
    int sign;
  };
  const auto product = [](Int128 x, Int128 y) {
    const int sign = sign_of(x) * sign_of(y);
    const Wide p = static_cast<Wide>(x < 0 ? -x : x), q = static_cast<Wide>(y < 0 ? -y : y);
    const Word p0 = static_cast<Word>(p), p1 = static_cast<Word>(p >> 64);
    const Word q0 = static_cast<Word>(q), q1 = static_cast<Word>(q >> 64);
    const Wide low = Wide{p0} * q0, high = Wide{p1} * q1;
    const Wide middle = Wide{p0} * q1 + (low >> 64);  // < 2^128
    const Wide other = Wide{p1} * q0 + static_cast<Word>(middle);
    return Product{
        high + (middle >> 64) + (other >> 64), (other << 64) | static_cast<Word>(low), sign};
  };
  const Product x = product(a, b), y = product(c, d);
  if (x.sign != y.sign)
    return x.sign < y.sign ? -1 : 1;
  const int larger = x.high != y.high ? (x.high > y.high ? 1 : -1)
                     : x.low != y.low ? (x.low > y.low ? 1 : -1)
                                      : 0;
  return larger * x.sign;
}
/// n times a power of two.
inline Expansion expansion_of(Int128 n, double unit) {
  const Int128 size = n < 0 ? -n : n;
  const std::uint64_t half[] = {static_cast<std::uint64_t>(size),
                                static_cast<std::uint64_t>(size >> 64)};
  Expansion sum;
  double scale = n < 0 ? -unit : unit;
  for (const std::uint64_t h : half)
    for (const std::uint32_t part :
         {static_cast<std::uint32_t>(h), static_cast<std::uint32_t>(h >> 32)}) {
      sum.add(part * scale);
      scale *= 0x1p32;
    }
  return sum;
}

}  // namespace grelha
