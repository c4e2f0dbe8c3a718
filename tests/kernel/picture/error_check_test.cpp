// A second set of samples: that it tells the error of the first, and of a picture that is wrong.
#include "kernel/picture/error_check.hpp"

#include <cmath>

#include "frontend/input/read_scene.hpp"
#include "kernel/picture/adaptive_sampler.hpp"
#include "kernel/picture/sampling_round.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

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

  ErrorCheck checked(const Refinement& picture) {
    grelha::Setup setup = set_up(world_, camera_, options_);
    setup.plan.on = true;
    setup.plan.samples = kMostSamples;
    BlockErrors errors(picture, 2);
    errors.estimate_block();
    return check_error(world_.impl(), setup, options_, errors, picture, stats_);
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

/// The check samples about 1024 of 16384 pixels. An eighth of the checked pixels vary, so their
/// mean has a relative error of a tenth or two.
TEST_F(Audits, TellTheTrueError) {
  const ErrorCheck found = checked(picture_);
  const double truth = true_mean_square();
  EXPECT_NEAR(found.agreeing.count + found.others.count, 128 * 128, 1e-6);
  EXPECT_GT(found.mean_square(), truth / 2);
  EXPECT_LT(found.mean_square(), truth * 2);
  EXPECT_GT(found.bound(), found.mean_square());
  EXPECT_LT(found.bound(), 3 * found.mean_square());
}

/// A picture that is too dark by d has a squared error of d squared. The check counts half of it,
/// computed from the difference between the wrong mean and a right one.
TEST_F(Audits, SeeThroughAPictureThatIsTooDark) {
  constexpr double kDarker = .05;
  const double before = checked(picture_).mean_square();
  Refinement dark = picture_;
  const Blocks blocks = dark.blocks();
  for (std::size_t i = 0; i < dark.sums.size(); ++i)
    dark.sums[i] -= static_cast<std::int64_t>(kDarker * kLightUnit *
                                              sample_count(dark, blocks.of_pixel(i / 3)));
  const ErrorCheck found = checked(dark);
  EXPECT_GT(found.mean_square(), before + .3 * kDarker * kDarker);
  EXPECT_TRUE(found.agreeing.exceeds_error() || found.others.exceeds_error());
}

/// The next check draws other pixels.
TEST_F(Audits, LookAtOtherPixelsEachTime) {
  const double first = checked(picture_).mean_square();
  Refinement next = picture_;
  ++next.checks;
  EXPECT_NE(checked(next).mean_square(), first);
}

/// A coarse error needs only a few checked pixels, because no single pixel could hide such an
/// error.
TEST_F(Audits, CostLittleWhereTheErrorIsCoarse) {
  const auto samples = [&](double error) {
    options_.refine.error = error;
    const std::uint64_t before = stats_.rays.primary;
    checked(picture_);
    return stats_.rays.primary - before;
  };
  const std::uint64_t all = total_samples(picture_);
  EXPECT_LT(samples(1), all / 100);
  EXPECT_GT(samples(.01), all / 25);
  EXPECT_LT(samples(.01), all / 10);
}

TEST_F(Audits, AreTheSameForAnyNumberOfThreads) {
  const double two = checked(picture_).mean_square();
  stats_.threads = 1;
  EXPECT_EQ(checked(picture_).mean_square(), two);
}

/// A check that disagrees gives only a rough estimate of the variances, so the next check follows
/// before the number of samples has doubled.
TEST_F(Audits, LetSamplesGrowByHalfUntilTheNext) {
  const std::uint64_t samples = total_samples(picture_);
  BlockErrors errors(picture_, 2);
  errors.estimate_block();
  const auto in_round = [&](int checks) {
    Refinement r = picture_;
    r.met = false;
    r.checks = checks;
    r.checked_at = samples;
    r.gain_threshold = 1e-12f;
    const std::vector<std::uint32_t> order = r.blocks().by_tiles();
    EXPECT_TRUE(choose_round(r, errors, {.error = 1e-4}, order, {samples, 0}));
    std::uint64_t next = 0;
    for (const std::uint32_t b : r.wanted)
      next += next_count(r, b) * kBlockPixels;
    return next;
  };
  ASSERT_GT(in_round(0), 6 * samples / 10) << "it could take more";
  EXPECT_LE(in_round(1), 51 * samples / 100);
  EXPECT_GE(in_round(1), 49 * samples / 100);
}

/// The last samples may reach the requested error without another check: the bound and met_at must
/// agree.
TEST(ErrorCheck, AgreesWithWhetherTheErrorIsMet) {
  SceneFile file =
      read_scene(GRELHA_SOURCE_DIR "/scenes/data/balls.nff", [](const std::string&) {});
  file.camera.width = file.camera.height = 64;
  const World world(file.scene, {});
  RenderOptions options;
  options.threads = 2;
  for (const double asked : {.006, .007, .01}) {
    options.refine.error = asked;
    RenderStats stats;
    render(world, file.camera, options, stats);
    EXPECT_EQ(stats.error.met_at > 0, stats.error.rmse_bound <= asked) << asked;
    EXPECT_LE(stats.error.met_at, stats.error.samples) << asked;
  }
}

TEST(CheckedPixels, AreNotWorseByChance) {
  CheckedPixels of;
  of.count = 100;
  of.claimed = 1;
  of.squared = 1.05;
  of.difference = .01;  // a spread of .1
  EXPECT_FALSE(of.exceeds_error());
  of.squared = 1.15;
  EXPECT_TRUE(of.exceeds_error());
}

TEST(CheckedPixels, SayHowMuchWorseWithinReason) {
  CheckedPixels of;
  EXPECT_EQ(of.error_ratio(3), 3) << "none of them";
  of.count = 100;
  of.claimed = 2;
  of.squared = 4;
  EXPECT_EQ(of.error_ratio(3), 6) << "beyond what it was taken for";
  of.squared = .5;
  EXPECT_EQ(of.error_ratio(3), 1);
  of.squared = 100;
  EXPECT_EQ(of.error_ratio(1), 16);
}

}  // namespace
}  // namespace grelha::test
