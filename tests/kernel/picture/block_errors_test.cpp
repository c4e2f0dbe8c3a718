// Tests the error estimate of a block from the squared differences of its samples and of those
// around it.
#include "kernel/picture/block_errors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/support/random.hpp"

namespace grelha::test {
namespace {

constexpr std::size_t kLevels[] = {1, 2, 4};  ///< squared differences: of halves, quarters, eighths

/// Black pixels with 2^log samples that all agree.
Refinement picture(int width, int height, std::uint8_t log) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  Refinement r = make_refinement(camera);
  r.log.assign(r.log.size(), log);
  return r;
}

BlockErrors judged(const Refinement& r) {
  BlockErrors errors(r, 1);
  errors.estimate();
  return errors;
}

/// One normal number (Box, Muller).
double normal(Random& random) {
  constexpr double kTurn = 6.283185307179586;
  const double radius = std::sqrt(-2 * std::log(1 - random.unit()));
  return radius * std::cos(kTurn * random.unit());
}

/// Fills in the squared differences of a pixel whose mean has this variance, and whose samples are
/// normal: at each level down the means are of half as many, and their variance is larger by
/// 1 / ratio. All channels are alike. After the first round there are two levels.
void draw(Refinement& r, std::size_t pixel, double variance, Random& random) {
  const double ratio = static_cast<double>(r.variance_ratio);
  const std::size_t levels = r.log[r.blocks().of_pixel(pixel)] == kFirstLog ? 2 : 3;
  double square = 4 * variance * (1 - ratio) / ratio;  // E[(A - B)^2] = 4 (V(n/2) - V(n))
  for (std::size_t level = 0; level < levels; ++level, square /= ratio) {
    double sum = 0;
    for (std::size_t k = 0; k < kLevels[level]; ++k)
      sum += square * std::pow(normal(random), 2);
    for (std::size_t c = 0; c < 3; ++c)
      r.squares[level][3 * pixel + c] = static_cast<float>(sum);
  }
}

/// Makes one sample of a pixel hit a light and all others nothing.
void hit(Refinement& r, std::size_t pixel, float light) {
  const std::uint32_t n = sample_count(r, r.blocks().of_pixel(pixel));
  for (std::size_t c = 0; c < 3; ++c) {
    r.sums[3 * pixel + c] = static_cast<std::int64_t>(static_cast<double>(light) * kLightUnit);
    for (std::size_t level = 0; level < (n == 1u << kFirstLog ? 2 : 3); ++level)
      r.squares[level][3 * pixel + c] =
          static_cast<float>(std::pow(double{light} * double(2u << level) / n, 2));
  }
}

/// The mean estimate of many pixels is their variance, after the first round and later, but for
/// the hit that is added to the 10 or 12 of each block.
TEST(BlockErrors, EstimateTheVarianceRightInTheMean) {
  constexpr int kSide = 64;
  constexpr double kVariance = 1e-4;
  for (const std::uint8_t log : {kFirstLog, kFirstLog + 2}) {
    Random random(log);
    Refinement r = picture(kSide, kSide, log);
    for (std::size_t p = 0; p < kSide * kSide; ++p)
      draw(r, p, kVariance, random);
    EXPECT_NEAR(judged(r).totals().sum / (kSide * kSide * kVariance), 1.1, .05) << int{log};
  }
}

/// Of pictures of 25 blocks, whose estimates chance moves, 19 in 20 have no larger error than the
/// bound says. That a hit is added makes it more.
TEST(BlockErrors, BoundTheErrorOfNineteenPicturesInTwenty) {
  constexpr int kPictures = 300, kSide = 20;
  constexpr double kVariance = 1e-4;
  Random random(1);
  int held = 0;
  for (int i = 0; i < kPictures; ++i) {
    Refinement r = picture(kSide, kSide, kFirstLog + 2);
    for (std::size_t p = 0; p < kSide * kSide; ++p)
      draw(r, p, kVariance, random);
    held += judged(r).totals().bound >= std::sqrt(kVariance);
  }
  EXPECT_GE(held, .95 * kPictures);
}

/// One sample that differs by .1 in one pixel is where a block's samples begin to disagree.
TEST(BlockErrors, SeeASampleThatDiffersByATenth) {
  const auto agrees = [](float difference) {
    Refinement r = picture(4, 4, kFirstLog + 2);
    hit(r, 5, difference);
    return judged(r).agrees(0);
  };
  EXPECT_TRUE(agrees(0));
  EXPECT_TRUE(agrees(.08f));
  EXPECT_FALSE(agrees(.15f));
  EXPECT_FALSE(agrees(1));
}

/// Light that one sample in `every` hits, on a black picture: hits by chance.
Refinement rarely_lit(std::uint32_t every, std::uint8_t log, Random& random, int side = 96) {
  Refinement r = picture(side, side, log);
  for (std::size_t p = 0; p < r.sums.size() / 3; ++p)
    if (random.below(every) < 1u << log)
      hit(r, p, 1);
  return r;
}

/// Blocks around tell a block how often samples hit, where few of its own did, or none.
TEST(BlockErrors, PoolRareHits) {
  for (const std::uint32_t every : {50u, 200u, 1000u}) {
    Random random(every);
    const Refinement r = rarely_lit(every, kFirstLog, random);
    const BlockErrors errors = judged(r);
    const double truth = 1. / every / (1 << kFirstLog);
    int claims = 0;
    for (std::size_t b = 0; b < r.log.size(); ++b)
      claims += errors.variance(b) > .2 * truth && errors.variance(b) < 5 * truth;
    EXPECT_GE(claims, static_cast<int>(r.log.size()) * 9 / 10) << every;
    const double hits = 96. * 96 * (1 << kFirstLog) / every;
    EXPECT_NEAR(errors.totals().rmse / std::sqrt(truth), 1, .15 + 1 / std::sqrt(hits)) << every;
  }
}

/// Blocks of another colour than hits make of black lend nothing, nor do edges that fill a block.
TEST(BlockErrors, LendNothingToAnotherSurface) {
  Random random(1);
  Refinement r = rarely_lit(500, kFirstLog, random, 24);
  const auto paint = [&](std::size_t block) {
    r.blocks().each_pixel(block, [&](std::size_t p) {
      for (std::size_t c = 0; c < 3; ++c) {
        r.sums[3 * p + c] = static_cast<std::int64_t>(.9 * kLightUnit * (1 << kFirstLog));
        for (auto& level : r.squares)
          level[3 * p + c] = 0;
      }
    });
  };
  paint(14);
  EXPECT_EQ(judged(r).variance(14), 0);
  EXPECT_GT(judged(r).variance(8), 0);
  Refinement edge = picture(24, 24, kFirstLog);
  edge.blocks().each_pixel(14, [&](std::size_t p) { draw(edge, p, 1e-3, random); });
  EXPECT_GT(judged(edge).variance(14), 0);
  EXPECT_EQ(judged(edge).variance(15), 0);
}

/// Pixels that are certainly beyond white are displayed as white, so differences of their samples
/// do not count.
TEST(BlockErrors, CountNothingBeyondWhite) {
  Random random(1);
  Refinement r = picture(4, 4, kFirstLog + 1);
  for (std::size_t p = 0; p < 16; ++p) {
    draw(r, p, 1e-2, random);
    for (std::size_t c = 0; c < 3; ++c)
      r.sums[3 * p + c] = static_cast<std::int64_t>(2 * kLightUnit * sample_count(r, 0));
  }
  EXPECT_EQ(judged(r).variance(0), 0);
  for (std::int64_t& sum : r.sums)
    sum /= 4;
  EXPECT_GT(judged(r).variance(0), 1e-3f);
}

/// What checks found corrects what samples say.
TEST(BlockErrors, AddWhatIsFoundBesideSamples) {
  Random random(1);
  Refinement r = picture(8, 4, kFirstLog);
  r.blocks().each_pixel(0, [&](std::size_t p) { draw(r, p, 1e-4, random); });
  const float alone = judged(r).variance(0);
  r.checked.y = 3;
  r.checked.x = 1;
  EXPECT_NEAR(judged(r).variance(0) / alone, 3, 1e-5);
  EXPECT_EQ(judged(r).claim(0), alone);
  r.missed[1] = .002f;
  EXPECT_FLOAT_EQ(judged(r).variance(1), .002f);
  r.missed[1] = 0;
  r.checked.ny = 8;
  r.checked.count = 100;
  EXPECT_FLOAT_EQ(judged(r).variance(1), .01f);
  EXPECT_FLOAT_EQ(judged(r).gains_per_ray()[1], .01f * .6f / 8);
  r.log[1] = kMostLog;
  EXPECT_EQ(judged(r).gains_per_ray()[1], 0) << "it can have no more";
}

/// Values cached in earlier rounds are updated with the samples taken since.
TEST(BlockErrors, FollowThePicture) {
  Random random(1);
  Refinement r = picture(13, 10, kFirstLog);
  BlockErrors errors(r, 2);
  for (int round = 0; round < 40; ++round) {
    const std::size_t b = random.below(static_cast<std::uint32_t>(r.log.size()));
    r.log[b] = static_cast<std::uint8_t>(std::min(r.log[b] + 1, kMostLog));
    r.variance_ratio = static_cast<float>(random.in(.2, .5));
    r.blocks().each_pixel(b, [&](std::size_t p) { draw(r, p, random.log_in(1e-6, 1e-2), random); });
    errors.estimate();
    const BlockErrors anew = judged(r);
    for (std::size_t i = 0; i < r.log.size(); ++i)
      ASSERT_EQ(errors.variance(i), anew.variance(i)) << round;
    ASSERT_EQ(errors.gains_per_ray(), anew.gains_per_ray()) << round;
  }
}

}  // namespace
}  // namespace grelha::test
