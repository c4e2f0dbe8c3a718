// Runs of one sequence for the pixels of a picture: where each lies, and that errors of neighbours
// make up for each other.
#define GRELHA_ISA scalar
#include "kernel/shade/strips.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "kernel/shade/sampling.hpp"

namespace grelha::scalar {
namespace {

/// Every square of a power of two a side, at a multiple of that, draws a run as long as it has
/// pixels, in an order that is not the same in all.
TEST(PixelCurve, DrawsSquareBySquare) {
  constexpr int kWidth = 45, kHeight = 70;
  const std::vector<std::uint32_t> places = drawing_places(kWidth, kHeight, 3);
  std::set<std::uint32_t> all(places.begin(), places.end());
  EXPECT_EQ(all.size(), std::size_t{kWidth * kHeight});
  EXPECT_LT(*all.rbegin(), 128u * 128);
  std::set<std::uint32_t> first_quarters;
  for (int level = 1; level <= 6; ++level)
    for (int y = 0; y + (1 << level) <= kHeight; y += 1 << level)
      for (int x = 0; x + (1 << level) <= kWidth; x += 1 << level) {
        const auto at = [&](int i, int j) { return places[std::size_t((y + j) * kWidth + x + i)]; };
        std::set<std::uint32_t> run;
        for (int j = 0; j < 1 << level; ++j)
          for (int i = 0; i < 1 << level; ++i)
            run.insert(at(i, j));
        ASSERT_EQ(*run.rbegin() - *run.begin() + 1, 1u << 2 * level) << x << ", " << y;
        ASSERT_EQ(*run.begin() % (1u << 2 * level), 0u);
        if (level == 1)
          first_quarters.insert((at(0, 0) % 4 * 4 + at(1, 0) % 4) * 4 + at(0, 1) % 4);
      }
  EXPECT_EQ(first_quarters.size(), 24u) << "all orders of four";
  EXPECT_NE(drawing_places(kWidth, kHeight, 4), places);
}

/// Errors of pixels that an edge crosses, for single pixels and for means of square groups: in four
/// dimensions of the joint sequence, and in two dimensions of a sequence that a key selects.
struct PictureErrors {
  double pixel = 0, square = 0;
};
PictureErrors errors_of(SamplePlan::Kind kind, int samples, std::uint32_t key) {
  constexpr int kAcross = 64, kSquare = 4, kSeeds = 64;
  constexpr double kEach = 1. / (kSeeds * kAcross * kAcross);
  PictureErrors sum;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    SamplePlan plan;
    plan.samples = samples;
    plan.kind = kind;
    plan.seed = seed;
    const Strata strata{1, 1, static_cast<std::uint32_t>(samples)};
    const std::vector<std::uint32_t> places = drawing_places(kAcross, kAcross, seed);
    plan.places = places.data();
    const auto error_of = [&](int x, int y) {
      int inside = 0;
      for (int i = 0; i < samples; ++i) {
        const auto index = static_cast<std::uint32_t>(i);
        const auto pixel = static_cast<std::uint32_t>(y * kAcross + x);
        const Pair a = sample_pair(plan, pixel, index, 0, key, strata),
                   b = sample_pair(plan, pixel, index, 2, key, strata);
        inside += key == 0 ? a.u + b.u < 1 && a.v + b.v < 1.2f : a.u + .7f * a.v < .8f;
      }
      return static_cast<double>(inside) / samples - (key == 0 ? .34 : .45);
    };
    for (int y = 0; y < kAcross; y += kSquare)
      for (int x = 0; x < kAcross; x += kSquare) {
        double together = 0;
        for (int k = 0; k < kSquare * kSquare; ++k) {
          const double e = error_of(x + k % kSquare, y + k / kSquare);
          sum.pixel += e * e * kEach;
          together += e;
        }
        sum.square += together * together / (kSquare * kSquare) * kEach;
      }
  }
  return {std::sqrt(sum.pixel), std::sqrt(sum.square)};
}

/// Pixels with their own sequences have independent errors, so the error of the mean of sixteen
/// pixels is a quarter. With runs of one sequence the errors of neighbours partly cancel. All
/// pixels share one scramble, so their errors are correlated: from 64 seeds to the next 64 the
/// ratio of their RMSE to the other varies by .02, that of squares by .01 (measured over 640
/// seeds). The test allows four times that.
TEST(Samples, OfBlueErrAsMuchButNotTogether) {
  for (const std::uint32_t key : {0u, 9u})
    for (const int samples : {1, 4, 9, 16}) {
      const PictureErrors apart = errors_of(SamplePlan::kSobol, samples, key);
      const PictureErrors blue = errors_of(SamplePlan::kBlue, samples, key);
      // runs of 9 begin anywhere in a net: .1 more
      const double tolerance = std::has_single_bit(static_cast<unsigned>(samples)) ? .08 : .18;
      EXPECT_NEAR(blue.pixel, apart.pixel, tolerance * apart.pixel) << samples << ", key " << key;
      EXPECT_NEAR(apart.square, apart.pixel / 4, .04 * apart.pixel / 4) << samples;
      EXPECT_LT(blue.square, .67 * apart.square) << samples << ", key " << key;  // .42 to .63
    }
}

}  // namespace
}  // namespace grelha::scalar
