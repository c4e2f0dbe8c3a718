#pragma once
// Numbers of 106 bits, as sums of two doubles: Dekker 1971; Hida, Li, Bailey, "Algorithms for
// Quad-Double Precision Floating Point Arithmetic", 2001.

#include <cmath>

#include "kernel/base/expansion.hpp"

namespace grelha {

/// + and - are within 2^-104 of the sum of their terms' magnitudes, *, / and square_root() within
/// 2^-100 of themselves.
struct DoubleDouble {
  double high = 0;
  double low = 0;

  DoubleDouble() = default;
  DoubleDouble(double x) : high(x) {}  // NOLINT: a double is one
  DoubleDouble(double x, double rest) : high(x + rest), low(rest - ((x + rest) - x)) {}
  explicit DoubleDouble(const Expansion& e) : DoubleDouble(e.estimate(), e.rest()) {}

  friend DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
    double high = 0;
    double low = 0;
    double high_of_rest = 0;
    double low_of_rest = 0;
    two_sum(a.high, b.high, high, low);
    two_sum(a.low, b.low, high_of_rest, low_of_rest);
    const DoubleDouble sum(high, low + high_of_rest);
    return {sum.high, sum.low + low_of_rest};
  }
  friend DoubleDouble operator-(const DoubleDouble& a) { return {-a.high, -a.low}; }
  friend DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }
  friend DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
    double high = 0;
    double low = 0;
    two_product(a.high, b.high, high, low);
    return {high, low + (a.high * b.low + a.low * b.high)};
  }
  friend DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
    const double first = a.high / b.high;
    const DoubleDouble left = a - b * first;
    const double second = left.high / b.high;
    const DoubleDouble left_then = left - b * second;
    return DoubleDouble(first, second) + left_then.high / b.high;
  }
  friend bool operator<(const DoubleDouble& a, const DoubleDouble& b) {
    return a.high < b.high || (a.high == b.high && a.low < b.low);
  }
  friend bool operator>(const DoubleDouble& a, const DoubleDouble& b) { return b < a; }
};

/// NaN of less than 0.
inline DoubleDouble square_root(const DoubleDouble& a) {
  const double x = std::sqrt(a.high);
  if (!(x > 0))
    return x;
  const DoubleDouble left = a - DoubleDouble(x) * x;
  return {x, left.high / (2 * x)};
}
inline DoubleDouble magnitude(const DoubleDouble& a) {
  return a < 0 ? -a : a;
}

struct WideVector {
  DoubleDouble x, y, z;
};

inline WideVector operator+(const WideVector& a, const WideVector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline WideVector operator-(const WideVector& a, const WideVector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline WideVector operator*(const DoubleDouble& s, const WideVector& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline WideVector cross(const WideVector& a, const WideVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline DoubleDouble dot(const WideVector& a, const WideVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

}  // namespace grelha
