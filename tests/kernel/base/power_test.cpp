// power(): near the true one, and the same bits in every copy.
#define GRELHA_ISA scalar
#include "kernel/base/power.hpp"

#include "tests/lanes/lane_functions.hpp"
#include "tests/support/rays.hpp"

namespace grelha::test {
namespace {

struct Arguments {
  std::vector<float> x, y;
};

Arguments sweep(int count) {
  Random random(3);
  Arguments a;
  for (int i = 0; i < count; ++i) {
    // Cosines crowd below 1, where high exponents tell them apart.
    const double x = random.chance(.4)   ? 1 - random.log_in(1e-7, .5)
                     : random.chance(.7) ? random.unit()
                                         : random.log_in(1e-30, 2);
    a.x.push_back(static_cast<float>(x));
    a.y.push_back(static_cast<float>(random.log_in(1e-3, 1e4)));
  }
  for (const float x : {0.f,
                        -0.f,
                        1.f,
                        .5f,
                        2.f,
                        1.4142135f,
                        .70710678f,
                        .70710671f,
                        1e-45f,
                        1e-38f,
                        .99999994f,
                        1.0000001f})
    for (const float y : {0.f, 1.f, 2.f, .5f, 1000.f, 1e-45f, 1e30f, kInf})
      a.x.push_back(x), a.y.push_back(y);
  return a;
}

/// log2 and exp2 promise 3e-7 each. An error of 3e-7 |log2 x| in log2 x, times y and ln 2, with one
/// rounding (6e-8) of the product, comes out of exp2 as a relative error of ln 2 (3e-7 + 6e-8) |y
/// log2 x|, beside exp2's own.
TEST(Power, StaysNearTheTrueOne) {
  const Arguments a = sweep(400000);
  double worst = 0;
  for (std::size_t i = 0; i < a.x.size(); ++i) {
    const float got = scalar::power(a.x[i], a.y[i]);
    if (!(a.x[i] > 1.2e-38f) || !(a.y[i] < 1e6f))
      continue;
    const long double wanted =
        std::pow(static_cast<long double>(a.x[i]), static_cast<long double>(a.y[i]));
    if (wanted > 0x1p126L)
      continue;  // beyond what a cosine can come to
    if (wanted < 0x1p-125L) {
      EXPECT_LT(got, 0x1p-124f);
      continue;
    }
    const long double exponent = std::abs(a.y[i] * std::log2(static_cast<long double>(a.x[i])));
    const double error = static_cast<double>(std::abs(got - wanted) / wanted /
                                             (3e-7L + .6931472L * 3.6e-7L * exponent));
    ASSERT_LE(error, 1) << a.x[i] << " ^ " << a.y[i] << " = " << static_cast<double>(wanted)
                        << ", got " << got;
    worst = std::max(worst, error);
  }
  std::printf("power: worst %.3f of the bound\n", worst);
}

TEST(Power, LogarithmAndExponentialKeepTheirBounds) {
  Random random(4);
  double worst_log = 0, worst_exp = 0;
  for (int i = 0; i < 1000000; ++i) {
    const float x =
        static_cast<float>(random.chance(.5) ? 1 + random.sign() * random.log_in(1e-7, .5)
                                             : random.log_in(1.2e-38, 2));
    if (x == 1)
      continue;
    const long double l = std::log2(static_cast<long double>(x));
    worst_log = std::max(worst_log, static_cast<double>(std::abs((scalar::log2_of(x) - l) / l)));
    const float y = static_cast<float>(random.in(-126, 127));
    const long double e = std::exp2(static_cast<long double>(y));
    worst_exp = std::max(worst_exp, static_cast<double>(std::abs(scalar::exp2_of(y) - e) / e));
  }
  std::printf("log2: worst relative error %.3g; exp2: %.3g\n", worst_log, worst_exp);
  EXPECT_LT(worst_log, 3e-7);
  EXPECT_LT(worst_exp, 3e-7);
}

TEST(Power, KnowsItsCorners) {
  EXPECT_EQ(scalar::power(0.f, 0.f), 1);
  EXPECT_EQ(scalar::power(.3f, 0.f), 1);
  EXPECT_EQ(scalar::power(1.f, 1000.f), 1);
  EXPECT_EQ(scalar::power(1.f, 1e30f), 1);
  EXPECT_LT(scalar::power(0.f, 1.f), 1e-37f);
  EXPECT_LT(scalar::power(0.f, 50.f), 1e-37f);
}

class PowerBits : public EveryVariant {};
GRELHA_FOR_EVERY_ISA(PowerBits);

TEST_P(PowerBits, AreThoseOfTheScalarCopy) {
  const Arguments a = sweep(20000);
  for (const int count : {1, 3, 7, 16, 1021, static_cast<int>(a.x.size())}) {
    std::vector<float> out(a.x.size(), -7.f);
    lane_functions(variant()).power(a.x.data(), a.y.data(), out.data(), count);
    for (int i = 0; i < count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      ASSERT_EQ(std::bit_cast<std::uint32_t>(out[k]),
                std::bit_cast<std::uint32_t>(scalar::power(a.x[k], a.y[k])))
          << a.x[k] << " ^ " << a.y[k];
    }
    if (static_cast<std::size_t>(count) < out.size()) {
      EXPECT_EQ(out[static_cast<std::size_t>(count)], -7.f);  // nothing behind the last
    }
  }
}

}  // namespace
}  // namespace grelha::test
