// Floats beside doubles: none on the wrong side, none farther than they must be.

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#define GRELHA_ISA scalar
#include "kernel/shapes/rounding.hpp"
#include "kernel/shapes/hit.hpp"
#include "kernel/base/lanes.hpp"
#include "tests/support/random.hpp"

namespace grelha::test {
namespace {

constexpr float kMost = std::numeric_limits<float>::max();

/// Doubles of all sizes that floats have, between two floats, on one, or next to one.
double any_double(Random& random) {
  const double size = random.log_in(1e-46, 3e38) * (random.chance(.5) ? 1 : -1);
  const double on = static_cast<float>(size);
  return random.chance(.3) ? on : random.chance(.3) ? std::nextafter(on, size) : size;
}

TEST(Rounding, FindsTheNextFloat) {
  for (std::uint64_t seed = 0; seed < 300000; ++seed) {
    Random random(seed);
    const double x = any_double(random);
    const float below = float_not_above(x);
    const float above = float_not_below(x);
    ASSERT_LE(below, x) << seed;
    ASSERT_GE(above, x) << seed;
    ASSERT_TRUE(below == above ? below == x : std::nextafter(below, kMost) == above) << seed;
    ASSERT_EQ(scalar::round_down(x), below) << seed;
    ASSERT_EQ(scalar::round_up(x), above) << seed;
  }
  EXPECT_EQ(float_not_above(0), 0);
  EXPECT_LT(float_not_above(-1e-60), 0);
  EXPECT_GT(float_not_below(1e-60), 0);
  EXPECT_TRUE(std::isnan(float_not_above(std::numeric_limits<double>::quiet_NaN())));
}

TEST(Rounding, KeepsFloatsBesideDoubles) {
  for (std::uint64_t seed = 0; seed < 300000; ++seed) {
    Random random(seed);
    const double x = any_double(random);
    const auto above = static_cast<float>(scalar::rounded_up(x));
    ASSERT_GE(above, x) << seed;
    ASSERT_LE(above, x + std::abs(x) * 0x1p-22 + 0x1p-148) << seed;
    const auto below = static_cast<float>(scalar::rounded_down(x));
    ASSERT_LE(below, x) << seed;
    ASSERT_GE(below, x - std::abs(x) * 0x1p-22 - 0x1p-148) << seed;
  }
}

/// t - shift, exactly: as a double and what that is off by.
struct Difference {
  double high = 0, low = 0;
  Difference(double t, double shift) { two_sum(t, -shift, high, low); }
  bool at_most(float bound) const { return high - bound < 0 || (high == bound && low <= 0); }
  bool at_least(float bound) const { return high - bound > 0 || (high == bound && low >= 0); }
};

// Ends and spans of rays that are moved to a grid hold what they held.
TEST(Rounding, KeepsSpansOfMovedRays) {
  for (std::uint64_t seed = 0; seed < 300000; ++seed) {
    Random random(seed);
    const auto t = static_cast<float>(random.sign() * random.log_in(1e-20, 1e20));
    double shift = random.sign() * random.log_in(1e-20, 1e20);
    if (random.chance(.5))  // a difference that doubles round to a float
      shift = static_cast<float>(shift);
    const Difference exact(t, shift);
    ASSERT_TRUE(exact.at_most(scalar::round_t_up(t, shift))) << seed;
    ASSERT_TRUE(exact.at_least(scalar::round_t_down(t, shift))) << seed;
    const CrossingSpan span =
        scalar::refine_span({true, true, t, t}, shift, [] { return ExactCrossing(); });
    ASSERT_TRUE(exact.at_most(span.hi) && exact.at_least(span.lo)) << seed;
  }
}

}  // namespace
}  // namespace grelha::test
