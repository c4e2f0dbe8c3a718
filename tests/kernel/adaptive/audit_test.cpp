// A second set of samples: that it tells the error of the first, and of a picture that is wrong.
#include "kernel/adaptive/audit.hpp"

#include <cmath>

#include "kernel/adaptive/adaptive_sampler.hpp"
#include "kernel/adaptive/pixel_order.hpp"
#include "kernel/adaptive/sampling_round.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

constexpr int kFirstLog = 2;

/// Balls over a wall, in front of a light: edges and shadows.
Scene balls_and_shadows() {
  Scene s = one_plane({0, 0, 0}, {0, 0, 1});
  s.lights = {{{6, 4, 12}, {1, 1, 1}}};
  Random random(3);
  for (int i = 0; i < 60; ++i)
    s.geometry.spheres.add(
        {float(random.in(-4, 4)), float(random.in(-4, 4)), float(random.in(1, 3))},
        float(random.in(.1, .5)),
        0);
  return s;
}

class Audits : public testing::Test {
 protected:
  Audits() : scene_(balls_and_shadows()), world_(scene_, {}) {
    camera_.eye = {0, 0, 20};
    camera_.at = {0, 0, 0};
    camera_.up = {0, 1, 0};
    camera_.angle_deg = 25;
    camera_.width = camera_.height = 128;
    options_.threads = 2;
    options_.refine.error = .02;
    picture_ = make_refinement(camera_);
    EXPECT_TRUE(refine(world_, camera_, options_, picture_, stats_));
  }

  Audit audited(const Refinement& picture) {
    AuditSamples none;
    return audited(picture, none);
  }
  Audit audited(const Refinement& picture, AuditSamples& samples) {
    grelha::Setup setup = set_up(world_, camera_, options_);
    setup.plan.on = true;
    setup.plan.samples = kMostSamples;
    PixelErrors errors(picture, false, kFirstLog, 2);
    errors.judge();
    return audit(world_.impl(), setup, options_, errors, picture, kFirstLog, samples, stats_);
  }

  double true_mean_square() const {
    RenderOptions many;
    many.threads = 2;
    many.sampling.samples = 1024;
    many.sampling.seed = 99;
    RenderStats stats;
    const Image truth = render(world_, camera_, many, stats);
    const Image image = picture_so_far(picture_);
    double sum = 0;
    for (std::size_t i = 0; i < truth.rgb.size(); ++i)
      sum += std::pow(double(image.rgb[i]) - double(truth.rgb[i]), 2);
    return sum / static_cast<double>(truth.rgb.size());
  }

  Scene scene_;
  World world_;
  Camera camera_;
  RenderOptions options_;
  RenderStats stats_;
  Refinement picture_;
};

/// Of 16384 pixels some 256, of which an eighth vary: their mean is off by a fifth or two.
TEST_F(Audits, TellTheTrueError) {
  const Audit found = audited(picture_);
  const double truth = true_mean_square();
  EXPECT_NEAR(found.agreeing.count + found.others.count, 128 * 128, 1e-6);
  EXPECT_GT(found.mean_square(), truth / 2);
  EXPECT_LT(found.mean_square(), truth * 2);
  EXPECT_GT(found.bound(), found.mean_square());
  EXPECT_LT(found.bound(), 3 * found.mean_square());
}

/// A picture that is too dark by d is off by d squared, of which half is counted: two means of
/// which one is wrong lie apart by that.
TEST_F(Audits, SeeThroughAPictureThatIsTooDark) {
  constexpr double kDarker = .05;
  const double before = audited(picture_).mean_square();
  Refinement dark = picture_;
  for (std::size_t i = 0; i < dark.sums.size(); ++i)
    dark.sums[i] -= static_cast<std::int64_t>(kDarker * kLightUnit * sample_count(dark, i / 3));
  const Audit found = audited(dark);
  EXPECT_GT(found.mean_square(), before + .3 * kDarker * kDarker);
  EXPECT_TRUE(found.agreeing.is_worse() || found.others.is_worse());
}

/// A run stops when its bound happens to be low: what is told is higher, up to the error asked for.
TEST_F(Audits, BoundsAllowForThatTheyMadeRunsStop) {
  PixelErrors errors(picture_, false, kFirstLog, 2);
  errors.judge();
  const double low = std::max(errors.totals().bound, std::sqrt(picture_.audited));
  ASSERT_LT(low, options_.refine.error);
  EXPECT_EQ(stats_.error.rmse_bound, std::min(1.15 * low, options_.refine.error));
  options_.refine = {.samples = 100000};
  Refinement budget = make_refinement(camera_);
  EXPECT_TRUE(refine(world_, camera_, options_, budget, stats_));
  PixelErrors of_budget(budget, false, kFirstLog, 2);
  of_budget.judge();
  EXPECT_EQ(stats_.error.rmse_bound, of_budget.totals().bound);
}

TEST_F(Audits, AreTheSameForAnyNumberOfThreads) {
  const double two = audited(picture_).mean_square();
  stats_.threads = 1;
  EXPECT_EQ(audited(picture_).mean_square(), two);
}

/// What an audit that disagrees makes of the variances is rough: the next one comes before samples
/// have doubled.
TEST_F(Audits, LetSamplesGrowByHalfUntilTheNext) {
  std::uint64_t samples = 0;
  for (std::size_t p = 0; p < picture_.log.size(); ++p)
    samples += sample_count(picture_, p);
  PixelErrors errors(picture_, false, kFirstLog, 2);
  errors.judge();
  const auto in_round = [&](int audits) {
    Refinement r = picture_;
    r.met = false;
    r.audits = audits;
    r.audited_at = samples;
    r.gain_threshold = 1e-12f;
    const std::vector<std::uint32_t> order = pixel_order(r.width, r.height);
    EXPECT_TRUE(choose_round(r, errors, {.error = 1e-4}, order, {samples, 0}, kFirstLog));
    std::uint64_t next = 0;
    for (const std::uint32_t p : r.wanted)
      next += next_count(r, p, kFirstLog);
    return next;
  };
  ASSERT_GT(in_round(0), 6 * samples / 10) << "it could take more";
  EXPECT_LE(in_round(1), 51 * samples / 100);
  EXPECT_GE(in_round(1), 49 * samples / 100);
}

/// An audit of a picture that went on says what one does that begins anew, and takes no sample that
/// an earlier one took.
TEST_F(Audits, GoOnWhereEarlierOnesEnded) {
  AuditSamples samples;
  audited(picture_, samples);
  options_.refine.error = .01;
  picture_.finished = picture_.met = false;
  EXPECT_TRUE(refine(world_, camera_, options_, picture_, stats_));
  const auto rays_of = [&](AuditSamples& some, double& mean_square) {
    const std::uint64_t before = stats_.rays.primary;
    mean_square = audited(picture_, some).mean_square();
    return stats_.rays.primary - before;
  };
  double anew = 0;
  double going_on = 0;
  double again = 0;
  AuditSamples none;
  const std::uint64_t all = rays_of(none, anew);
  const std::uint64_t rest = rays_of(samples, going_on);
  EXPECT_EQ(going_on, anew);
  EXPECT_GT(rest, 0u);
  EXPECT_LT(rest, all);
  EXPECT_EQ(rays_of(samples, again), 0u);
  EXPECT_EQ(again, anew);
}

TEST(AuditedPixels, AreNotWorseByChance) {
  AuditedPixels of;
  of.count = 100;
  of.claimed = 1;
  of.squared = 1.05;
  of.difference = .01;  // a spread of .1
  EXPECT_FALSE(of.is_worse());
  of.squared = 1.15;
  EXPECT_TRUE(of.is_worse());
}

TEST(AuditedPixels, SayHowMuchWorseWithinReason) {
  AuditedPixels of;
  EXPECT_EQ(of.how_much_worse(3), 3) << "none of them";
  of.count = 100;
  of.claimed = 2;
  of.squared = 4;
  EXPECT_EQ(of.how_much_worse(3), 6) << "beyond what it was taken for";
  of.squared = .5;
  EXPECT_EQ(of.how_much_worse(3), 1);
  of.squared = 100;
  EXPECT_EQ(of.how_much_worse(1), 16);
}

}  // namespace
}  // namespace grelha::test
