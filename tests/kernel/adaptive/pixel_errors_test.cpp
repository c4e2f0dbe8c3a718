// What the squared differences of a pixel's samples say of its error.
#include "kernel/adaptive/pixel_errors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/support/random.hpp"

namespace grelha::test {
namespace {

constexpr int kFirstLog = 3;
constexpr std::size_t kLevels[] = {1, 2, 4};  ///< squared differences: of halves, quarters, eighths

/// Pixels that had so many samples, that stand alone, and of which nothing is known yet.
Refinement pixels(int width, std::uint8_t log) {
  Camera camera;
  camera.width = width;
  camera.height = 1;
  Refinement r = make_refinement(camera);
  const std::size_t n = static_cast<std::size_t>(width);
  r.log.assign(n, log);
  r.cost.assign(n, 1);
  return r;
}

PixelErrors judged(const Refinement& r) {
  PixelErrors errors(r, false, kFirstLog, 1);
  errors.judge();
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
  const std::size_t levels = r.log[pixel] == kFirstLog ? 2 : 3;
  double square = 4 * variance * (1 - ratio) / ratio;  // E[(A - B)^2] = 4 (V(n/2) - V(n))
  for (std::size_t level = 0; level < levels; ++level, square /= ratio) {
    double sum = 0;
    for (std::size_t k = 0; k < kLevels[level]; ++k)
      sum += square * std::pow(normal(random), 2);
    for (std::size_t c = 0; c < 3; ++c)
      r.squares[level][3 * pixel + c] = static_cast<float>(sum);
  }
}

/// The mean estimate of many pixels is their variance, after the first round and later. Of 4000
/// pixels with 3 or 7 differences it has a standard deviation of sqrt(2 / 3 / 4000) = .013.
TEST(PixelErrors, EstimateTheVarianceRightInTheMean) {
  constexpr int kPixels = 4000;
  constexpr double kVariance = 1e-4;
  for (const std::uint8_t log : {kFirstLog, kFirstLog + 2}) {
    Random random(log);
    Refinement r = pixels(kPixels, log);
    for (std::size_t p = 0; p < kPixels; ++p)
      draw(r, p, kVariance, random);
    const PixelErrors errors = judged(r);
    EXPECT_NEAR(errors.totals().sum / kPixels / kVariance, 1, .06) << int{log};
  }
}

/// A pixel's interval is wide enough for 95 % of normal errors of its variance.
TEST(PixelErrors, MakeIntervalsOfNineteenInTwenty) {
  constexpr int kDraws = 10000;
  constexpr double kVariance = 1e-4;
  Random random(1);
  Refinement r = pixels(1, kFirstLog + 2);
  double square = 4 * kVariance * .6 / .4;
  for (std::size_t level = 0; level < 3; ++level, square /= .4)
    for (std::size_t c = 0; c < 3; ++c)
      r.squares[level][c] = static_cast<float>(kLevels[level] * square);
  const double half = static_cast<double>(judged(r).widths()[0]) / 2;
  int inside = 0;
  for (int i = 0; i < kDraws; ++i)
    inside += std::abs(std::sqrt(kVariance) * normal(random)) <= half;
  EXPECT_NEAR(inside, .95 * kDraws, 4 * std::sqrt(.95 * .05 * kDraws));
}

/// Of pictures of 400 pixels, whose estimates chance moves, 19 in 20 have no larger error than the
/// bound says, before the bound allows for what stopping at chance does.
TEST(PixelErrors, BoundTheErrorOfNineteenPicturesInTwenty) {
  constexpr int kPictures = 1000;
  constexpr int kPixels = 400;
  constexpr double kVariance = 1e-4;
  Random random(1);
  int held = 0;
  for (int i = 0; i < kPictures; ++i) {
    Refinement r = pixels(kPixels, kFirstLog + 2);
    for (std::size_t p = 0; p < kPixels; ++p)
      draw(r, p, kVariance, random);
    held += judged(r).totals().bound >= 1.12 * std::sqrt(kVariance);
  }
  EXPECT_GE(held, .92 * kPictures);
  EXPECT_LE(held, .98 * kPictures);
}

/// Samples of which one differs from all others by this, the first of the sequence.
bool agree_but_for_one(float difference) {
  Refinement r = pixels(1, kFirstLog + 2);
  const float n = static_cast<float>(sample_count(r, 0));
  for (std::size_t level = 0; level < 3; ++level)
    for (std::size_t c = 0; c < 3; ++c) {
      const float of_means = difference * static_cast<float>(2u << level) / n;
      r.squares[level][c] = of_means * of_means;
    }
  return judged(r).agrees(0);
}

/// One sample that differs by .1 is where samples begin to disagree.
TEST(PixelErrors, SeeASampleThatDiffersByATenth) {
  EXPECT_TRUE(agree_but_for_one(0));
  EXPECT_TRUE(agree_but_for_one(.08f));
  EXPECT_FALSE(agree_but_for_one(.12f));
  EXPECT_FALSE(agree_but_for_one(1));
}

/// Light that is forgiven, were it to hide in every pixel, would leave a third of the error asked
/// for: with that the whole is off by a twentieth.
TEST(PixelErrors, ForgiveWhatLeavesATwentieth) {
  for (const double error : {.1, .01, .001}) {
    Refinement r = pixels(3, kFirstLog);
    r.around.assign(3, 0);
    r.inside.assign(3, PixelErrors(r, false, kFirstLog, 1).forgiven(error));
    const double left = judged(r).totals().rmse / error;
    EXPECT_LE(std::hypot(1, left), 1.055) << error;
    EXPECT_GT(left, .3) << error;  // and no more is followed than that takes
  }
}

/// Edges that are not asked about, were they in every pixel, would leave a quarter of it among four
/// samples.
TEST(PixelErrors, TakeFaintDifferencesForNoEdge) {
  constexpr int kLogOfFour = 2;
  for (const double error : {.03, .01, .001}) {
    const float faint = PixelErrors::faint(error);
    Refinement r = pixels(2, kLogOfFour);
    r.inside.assign(2, 0);
    r.around.assign(2, 1);
    for (std::size_t c = 3; c < 6; ++c)
      r.sums[c] = static_cast<std::int64_t>(4 * double{faint} * kLightUnit);
    PixelErrors errors(r, false, kLogOfFour, 1);
    errors.judge();
    ASSERT_NEAR(errors.contrast(0, 0), faint, 1e-6);
    const double left = errors.totals().rmse / error;
    EXPECT_LE(left, .26) << error;
    EXPECT_GT(left, .2) << error;
  }
  EXPECT_LE(PixelErrors::faint(0) * 256, 4);  // steps of a picture of 8 bits
}

/// Each of the eight pixels around a pixel that may hide something lends it as much.
TEST(PixelErrors, BorrowFromEightPixels) {
  constexpr int kWidth = 5;
  constexpr int kMiddle = 12;
  Camera camera;
  camera.width = camera.height = kWidth;
  for (const int step : {-6, -5, -4, -1, 1, 4, 5, 6}) {
    const std::size_t lender = static_cast<std::size_t>(kMiddle + step);
    Refinement r = make_refinement(camera);
    r.log.assign(kWidth * kWidth, kFirstLog + 1);
    r.cost.assign(kWidth * kWidth, 1);
    r.inside.assign(kWidth * kWidth, 1e-6f);
    r.squares[0][3 * lender] = 1;
    const PixelErrors errors = judged(r);
    EXPECT_NEAR(errors.variance(kMiddle) / errors.variance(lender), 1. / 8, 1e-3) << step;
  }
}

/// What is kept of a pixel from one round to the next follows the samples of those around it.
TEST(PixelErrors, FollowThePixelsAround) {
  constexpr int kWidth = 4;
  Refinement r = pixels(kWidth, kFirstLog);
  r.inside.assign(kWidth, 0);
  r.around.assign(kWidth, 1);
  PixelErrors errors(r, false, kFirstLog, 1);
  errors.judge();
  for (const std::size_t p : {1, 3, 2, 0}) {
    ++r.log[p];
    for (std::size_t c = 0; c < 3; ++c)
      r.sums[3 * p + c] = static_cast<std::int64_t>((p + 1) * kLightUnit);
    errors.judge();
    EXPECT_EQ(errors.widths(), judged(r).widths()) << p;
    EXPECT_EQ(errors.gains_per_ray(), judged(r).gains_per_ray()) << p;
  }
}

/// The widest interval of two pixels that differ so much, of 2^log samples that agree.
float width_at_edge(float difference, std::uint8_t log) {
  Refinement r = pixels(2, log);
  r.inside.assign(2, 0);
  r.around.assign(2, 1);
  for (std::size_t c = 3; c < 6; ++c)
    r.sums[c] =
        static_cast<std::int64_t>((1 << log) * static_cast<double>(difference) * kLightUnit);
  const PixelErrors errors = judged(r);
  EXPECT_NEAR(errors.contrast(0, 0), difference, 1e-6);
  return errors.widths()[0];
}

/// Of edges that are left to samples 16 know enough, and fewer do not.
TEST(PixelErrors, LeaveEdgesToSixteenSamples) {
  constexpr float kWidest = 8;  // errors asked for, see kWidestInterval
  for (const float error : {.01f, .003f, .001f}) {
    const float dear = PixelErrors::dear(double{error});
    EXPECT_LE(width_at_edge(dear, 4), 1.001f * kWidest * error);
    EXPECT_GT(width_at_edge(dear, 3), kWidest * error);
    EXPECT_GT(width_at_edge(1.1f * dear, 4), kWidest * error);
  }
  EXPECT_EQ(PixelErrors::dear(0), PixelErrors::faint(0));
}

/// The interval of a pixel of which one sample met light `sent` in one channel and all others
/// nothing, where `inside` is doubted.
float width_of_one(std::uint8_t log, float ratio, float sent, float inside) {
  Refinement r = pixels(1, log);
  r.variance_ratio = ratio;
  r.inside = {inside};
  r.around = {0};
  const float of_one = sent / static_cast<float>(1 << log);
  float square = 4 * of_one * of_one;
  for (int level = 0; level < (log == kFirstLog ? 2 : 3); ++level, square *= 4)
    r.squares[static_cast<std::size_t>(level)][1] = square;
  return judged(r).widths()[0];
}

/// A lamp is doubted among samples that vary less than one would that met it, and no longer once
/// one did. What is no brighter than white is doubted among samples that agree alone.
TEST(PixelErrors, DoubtLampsUntilASampleMeetsThem) {
  constexpr float kSent = 40;  // Glows say up to twice as much
  for (const std::uint8_t log : {std::uint8_t{kFirstLog}, std::uint8_t{10}})
    for (const float ratio : {.1f, .4f, .7f}) {
      const auto width = [&](float sent, float inside) {
        return width_of_one(log, ratio, sent, inside);
      };
      const float hidden = 6 * std::min(2 * kSent / static_cast<float>(1 << log), 1.f);
      EXPECT_EQ(width(.2f, 2 * kSent), hidden) << ratio;
      EXPECT_EQ(width(kSent, 2 * kSent), width(kSent, 0)) << ratio;
      EXPECT_EQ(width(kSent, kSent), width(kSent, 0)) << ratio;
      EXPECT_EQ(width(1, 1), width(1, 0)) << ratio;
    }
}

/// Where there are effects to sample, a pixel whose samples agree by chance borrows from those
/// around it; where neither tells anything there is no error.
TEST(PixelErrors, BorrowWhereSamplesAgreeByChance) {
  Refinement r = pixels(5, kFirstLog);
  r.around.assign(5, 0);
  Random random(1);
  draw(r, 0, 1e-4, random);
  PixelErrors errors(r, true, kFirstLog, 1);
  errors.judge();
  EXPECT_GT(errors.variance(1), 0);
  EXPECT_EQ(errors.variance(3), 0);
}

/// Pixels of which nothing but their samples tells are judged many at a time: as one by one.
TEST(PixelErrors, JudgeManyAsOneByOne) {
  Random random(1);
  for (std::uint8_t log = kFirstLog; log <= kMostLog; ++log)
    for (const double least : {0., 1e-3}) {
      Refinement r = pixels(1, log);
      r.worse = random.in(1, 4);
      r.least_by_sample = least;
      r.cost[0] = static_cast<float>(random.in(1, 9));
      if (random.below(2) == 1)  // else its samples agree
        draw(r, 0, random.log_in(1e-9, 1e-2), random);
      r.around[0] = 0;
      const PixelErrors many = judged(r);
      r.around[0] = 1;  // as far as it differs from those around it, of which there are none
      const PixelErrors one = judged(r);
      EXPECT_EQ(many.variance(0), one.variance(0)) << int{log};
      EXPECT_EQ(many.widths()[0], one.widths()[0]) << int{log};
      EXPECT_EQ(many.gains_per_ray()[0], one.gains_per_ray()[0]) << int{log};
    }
}

/// What the means of halves, quarters and eighths of n samples differ by, squared, where one has
/// `one` units of light and all others `rest`.
float square_of_one(std::int64_t one, std::int64_t rest, double n, int level) {
  const double part = n / static_cast<double>(2u << level);
  const double light = static_cast<double>(rest) * part;
  const double with = (light + static_cast<double>(one - rest)) / (part * kLightUnit);
  const double without = light / (part * kLightUnit);
  return static_cast<float>((with - without) * (with - without));
}

/// One sample that met a lamp ends the doubt of it, whatever rounding leaves of its light: in
/// shading, in units, in means beside other light, in squares.
TEST(PixelErrors, KnowALampByOneSampleWhateverIsRounded) {
  Random random(1);
  for (int i = 0; i < 3000; ++i) {
    const auto log = static_cast<std::uint8_t>(kFirstLog + 1 + random.below(12));
    const float lamp = static_cast<float>(random.log_in(1.01, 300));
    const double sent = .5 * double{lamp} * (1 - 0x1p-20);  // glows say up to twice as much
    const double rest = random.unit();
    const auto units = [](double light) { return static_cast<std::int64_t>(light * kLightUnit); };
    Refinement r = pixels(1, log);
    r.variance_ratio = static_cast<float>(random.in(.1, .9));
    r.around = {0};
    for (int level = 0; level < 3; ++level)
      std::ranges::fill(r.squares[static_cast<std::size_t>(level)],
                        square_of_one(units(rest + sent), units(rest), 1u << log, level));
    r.inside = {0};
    const float known = judged(r).widths()[0];
    r.inside = {lamp};
    ASSERT_EQ(judged(r).widths()[0], known) << lamp << " of " << (1 << log) << ", " << rest;
  }
}

/// What is in a box counts as missed until samples are sent there: a disc in the box, of which the
/// mean shows nothing. Then it is what none of them may have met, as in a pixel.
TEST(PixelErrors, CountWhatIsInABoxAsMissed) {
  Refinement r = pixels(3, kFirstLog);
  r.inside.assign(3, 0);
  r.around.assign(3, 0);
  r.boxed = {0, 2, 2};
  r.box = {0, 0x3F3F2020, 0x3F3F2020};  // an eighth of the pixel each way
  r.log[2] = kFirstLog + 1;             // of 8 new samples 4 went to the box
  const PixelErrors errors = judged(r);
  constexpr float kMost = 2.f / 64;
  constexpr float kDisc = .785398f * kMost;
  EXPECT_EQ(errors.variance(0), 0);
  EXPECT_NEAR(errors.variance(1) / (kDisc * kDisc), 1, 1e-5);
  EXPECT_NEAR(errors.widths()[1] / (2 * kMost), 1, 1e-5);
  EXPECT_NEAR(errors.variance(2) / (.15f * kMost * kMost / 16), 1, 1e-5);
  EXPECT_NEAR(errors.widths()[2] / (6 * kMost / 4), 1, 1e-5);
}

/// Sets all that is known of a pixel to anything: some channels are brighter than white.
void redraw(Refinement& r, std::size_t p, Random& random) {
  draw(r, p, random.log_in(1e-6, 1e-2), random);
  for (std::size_t i = 3 * p; i < 3 * p + 3; ++i)
    r.sums[i] = static_cast<std::int64_t>(random.in(-.1, 1.3) * kLightUnit * sample_count(r, p));
}

/// By the book: the mean of the variances of channels, each by its own differences. One that is
/// surely shown as white, whatever its error, counts as none.
double variance_by_the_book(const Refinement& r, std::size_t p) {
  const double ratio = static_cast<double>(r.variance_ratio);
  const double freedom = r.log[p] == kFirstLog ? 3 : 7;
  double sum = 0;
  for (std::size_t i = 3 * p; i < 3 * p + 3; ++i) {
    const double differences = double{r.squares[0][i]} +
                               ratio * (double{r.squares[1][i]} + ratio * double{r.squares[2][i]});
    const double variance = ratio / (1 - ratio) / (4 * freedom) * differences;
    const double mean = static_cast<double>(r.sums[i]) / kLightUnit / sample_count(r, p);
    if (!(mean - 3 * std::sqrt(variance) > 1))
      sum += variance;
  }
  return sum / 3;
}

/// After each round what is told is told of the picture as it is, of old samples and new.
TEST(PixelErrors, TellThePictureAsItIs) {
  Random random(1);
  Refinement r = pixels(300, kFirstLog);
  r.around.assign(300, 0);
  for (std::size_t p = 0; p < 300; ++p)
    redraw(r, p, random);
  PixelErrors errors(r, false, kFirstLog, 2);
  for (int round = 0; round < 30; ++round) {
    for (std::uint32_t n = random.below(40); n > 0; --n) {
      const std::size_t p = random.below(300);
      r.log[p] = static_cast<std::uint8_t>(std::min(r.log[p] + 1, 12));
      redraw(r, p, random);
    }
    if (random.chance(.5))
      r.variance_ratio = static_cast<float>(random.in(.2, .6));
    errors.judge();
    for (std::size_t p = 0; p < 300; ++p) {
      const double variance = variance_by_the_book(r, p);
      ASSERT_NEAR(double{errors.variance(p)}, variance, 1e-5 * variance) << round << ": " << p;
    }
  }
}

}  // namespace
}  // namespace grelha::test
