#pragma once
// Seeded values for sweeps. Own arithmetic throughout: the standard distributions differ between
// libraries, and a seed in a failure message must mean the same numbers everywhere.

#include <cmath>
#include <cstdint>
#include <limits>

#include "grelha/geometry.hpp"

namespace grelha::test {

inline constexpr float kInf = std::numeric_limits<float>::infinity();
inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// SplitMix64 (Steele, Lea, Flood 2014): any seed, also 0, gives a good stream.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15u + 0x1234567u) {}

  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }  ///< [0, 1)
  double in(double lo, double hi) { return lo + (hi - lo) * unit(); }
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(next() % n); }
  bool chance(double p) { return unit() < p; }
  /// Returns a value whose logarithm is uniform: as many values between 1e-3 and 1e-2 as between 10
  /// and 100. This finds errors at unusual sizes.
  double log_in(double lo, double hi) { return std::exp(in(std::log(lo), std::log(hi))); }
  double sign() { return chance(.5) ? 1 : -1; }

  /// Evenly on the unit ball's surface.
  Float3 direction() {
    for (;;) {
      const double x = in(-1, 1), y = in(-1, 1), z = in(-1, 1), s = x * x + y * y + z * z;
      if (s > 1 || s < 1e-4)
        continue;
      const double k = 1 / std::sqrt(s);
      return {static_cast<float>(x * k), static_cast<float>(y * k), static_cast<float>(z * k)};
    }
  }
  Float3 point(double half) {
    const double x = in(-half, half), y = in(-half, half), z = in(-half, half);
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
  }
  /// A value that breaks careless comparisons.
  float odd() {
    static constexpr float values[] = {0.f,
                                       -0.f,
                                       kNaN,
                                       kInf,
                                       -kInf,
                                       1e-45f,
                                       -1e-45f,
                                       1e-40f,
                                       -3e-39f,
                                       1.2e-38f,
                                       3e38f,
                                       -3e38f,
                                       1e-20f};
    return values[below(sizeof values / sizeof *values)];
  }
  float zero() { return chance(.5) ? 0.f : -0.f; }

 private:
  std::uint64_t state_;
};

inline Float3 at(const Float3& a, double s, const Float3& d) {
  return {static_cast<float>(a.x + s * d.x),
          static_cast<float>(a.y + s * d.y),
          static_cast<float>(a.z + s * d.z)};
}
inline Float3 minus(const Float3& a, const Float3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Float3 scaled(const Float3& a, double s) {
  return {static_cast<float>(a.x * s), static_cast<float>(a.y * s), static_cast<float>(a.z * s)};
}
inline float& component(Float3& v, std::uint32_t a) {
  return a == 0 ? v.x : a == 1 ? v.y : v.z;
}

}  // namespace grelha::test
