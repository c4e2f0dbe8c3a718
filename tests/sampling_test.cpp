// Where samples lie: nets, slopes of convergence, pairings without bias.
#define GRELHA_ISA scalar
#include "kernel/sampling.hpp"

#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace grelha::scalar {
namespace {

SamplePlan plan_of(SamplePlan::Kind kind, std::uint32_t seed, int samples) {
  SamplePlan p;
  p.on = true, p.kind = kind, p.seed = seed, p.samples = samples;
  const auto side = static_cast<std::uint32_t>(std::lround(std::sqrt(samples)));
  p.pixel_strata = p.light_strata = {side, side};
  return p;
}

TEST(Sobol, EveryDimensionFillsEveryInterval) {
  for (int d = 0; d < kSobolDimensions; ++d)
    for (const std::uint32_t seed : {1u, 77u}) {
      std::set<int> seen;
      for (std::uint32_t i = 0; i < 256; ++i) seen.insert(static_cast<int>(sobol_sample(seed, i, d) * 256));
      EXPECT_EQ(seen.size(), 256u) << "dimension " << d;
    }
}

TEST(Sobol, FirstTwoDimensionsAreANet) {
  for (std::uint32_t seed = 0; seed < 20; ++seed)
    for (int k = 0; k <= 8; ++k) {  // 2^k columns by 2^(8-k) rows: one point in each
      std::set<int> seen;
      for (std::uint32_t i = 0; i < 256; ++i)
        seen.insert(static_cast<int>(sobol_sample(seed, i, 0) * (1 << k)) * 256 + static_cast<int>(sobol_sample(seed, i, 1) * (1 << (8 - k))));
      EXPECT_EQ(seen.size(), 256u) << "seed " << seed << ", 2^" << k << " columns";
    }
}

TEST(Samples, AreFunctionsOfTheirIndex) {
  const SamplePlan p = plan_of(SamplePlan::kSobol, 9, 16), q = plan_of(SamplePlan::kSobol, 10, 16);
  const Pair a = sample_pair(p, 5, 3, 2, 0, p.light_strata), b = sample_pair(p, 5, 3, 2, 0, p.light_strata);
  EXPECT_TRUE(a.u == b.u && a.v == b.v);
  const Pair seed = sample_pair(q, 5, 3, 2, 0, p.light_strata), pixel = sample_pair(p, 6, 3, 2, 0, p.light_strata),
             key = sample_pair(p, 5, 3, 2, 8, p.light_strata);
  for (const Pair& other : {seed, pixel, key}) EXPECT_NE(a.u, other.u);
}

/// Root mean square error of an integrand over the first four dimensions with `n` samples, over many pixels.
using Integrand = std::function<bool(const Pair&, const Pair&)>;
double rmse(SamplePlan::Kind kind, int n, double truth, const Integrand& f, double* mean = nullptr, bool shuffled = true) {
  constexpr int kPixels = 1000;
  const SamplePlan p = plan_of(kind, 3, n);
  double sum = 0, errors = 0;
  for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
    int inside = 0;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(n); ++i) {
      const Pair a = sample_pair(p, pixel, i, 0, 0, p.pixel_strata);
      const Pair b = shuffled ? sample_pair(p, pixel, i, 2, 0, p.light_strata) : jittered(scatter(pixel, 99), i, p.light_strata, false);
      inside += f(a, b);
    }
    const double e = static_cast<double>(inside) / n - truth;
    sum += e, errors += e * e;
  }
  if (mean) *mean = sum / kPixels;
  return std::sqrt(errors / kPixels);
}

bool disc(const Pair& a, const Pair&) { return a.u * a.u + a.v * a.v < 2 / std::numbers::pi; }
bool soft(const Pair& a, const Pair& b) { return a.u + b.u < 1 && a.v + b.v < 1.2; }

double slope(SamplePlan::Kind kind, double truth, const Integrand& f) {
  return std::log(rmse(kind, 16, truth, f) / rmse(kind, 1024, truth, f)) / std::log(64.);
}

// Published and re-measured slopes: random .5; jitter and Sobol .7 to .8 on edges; with an edge in four dimensions shuffled
// jitter falls back to .5 and one joint Sobol sequence keeps .7. An RMSE over 1000 pixels is known to 2.2 %, a slope over a
// factor of 64 to .01; the bounds leave five of these.
TEST(Convergence, OnAnEdge) {
  EXPECT_NEAR(slope(SamplePlan::kRandom, .5, disc), .50, .05);
  EXPECT_NEAR(slope(SamplePlan::kJitter, .5, disc), .71, .05);
  EXPECT_NEAR(slope(SamplePlan::kSobol, .5, disc), .76, .05);
}

TEST(Convergence, OnAnEdgeInFourDimensions) {
  EXPECT_NEAR(slope(SamplePlan::kJitter, .34, soft), .5, .05);
  EXPECT_NEAR(slope(SamplePlan::kSobol, .34, soft), .71, .05);
  EXPECT_LT(rmse(SamplePlan::kSobol, 256, .34, soft), .6 * rmse(SamplePlan::kJitter, 256, .34, soft));
}

TEST(Pairing, HasNoBiasUnlessItIsNotShuffled) {
  for (const auto kind : {SamplePlan::kSobol, SamplePlan::kJitter, SamplePlan::kRandom}) {
    double mean = 0;
    const double error = rmse(kind, 16, .34, soft, &mean);
    EXPECT_LT(std::abs(mean), 4 * error / std::sqrt(1000.)) << kind;
  }
  double mean = 0;
  const double error = rmse(SamplePlan::kJitter, 16, .34, soft, &mean, false);
  EXPECT_GT(std::abs(mean), 4 * error / std::sqrt(1000.)) << "the same order for both must show";
}

TEST(Pairing, KeepsKeysApart) {
  // The second light and every bounce have sequences of their own: pairing two of them must not be biased either.
  const SamplePlan p = plan_of(SamplePlan::kSobol, 3, 64);
  double sum = 0, errors = 0;
  for (std::uint32_t pixel = 0; pixel < 1000; ++pixel) {
    int inside = 0;
    for (std::uint32_t i = 0; i < 64; ++i) inside += soft(sample_pair(p, pixel, i, 2, 11, {}), sample_pair(p, pixel, i, 2, 12, {}));
    const double e = inside / 64. - .34;
    sum += e, errors += e * e;
  }
  EXPECT_LT(std::abs(sum / 1000), 4 * std::sqrt(errors / 1000 / 1000));
  EXPECT_LT(std::sqrt(errors / 1000), .0444) << "no worse than padded Owen sets: .040, plus five times 2.2 %";
}

TEST(Disc, IsRoundAndEven) {
  constexpr int n = 256;
  int inner = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Pair p = disc_point({(static_cast<float>(i) + .5f) / n, (static_cast<float>(j) + .5f) / n});
      const double r2 = static_cast<double>(p.u) * p.u + static_cast<double>(p.v) * p.v;
      ASSERT_LE(r2, 1 + 1e-6);
      inner += r2 < .5;
    }
  // Squares keep their share of the area: half of them within radius sqrt(1/2), but for the ring of squares on the border.
  EXPECT_NEAR(inner, n * n / 2, 4 * n);
  const Pair edge = disc_point({1 - 0x1p-24f, .75f});
  EXPECT_NEAR(edge.u, std::cos(std::numbers::pi / 8), 1e-6);
  EXPECT_NEAR(edge.v, std::sin(std::numbers::pi / 8), 1e-6);
}

}  // namespace
}  // namespace grelha::scalar
