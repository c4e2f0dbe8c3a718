// A second set of samples: that it tells the error of the first, and of a picture that is wrong.
#include "kernel/picture/sampling_round.hpp"

#include <cmath>

#include "frontend/input/read_scene.hpp"
#include "kernel/picture/adaptive_sampler.hpp"
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

  CheckSums checked(const Refinement& picture) {
    grelha::Setup setup = set_up(world_, camera_, options_);
    setup.plan.on = true;
    setup.plan.samples = kMostSamples;
    BlockErrors errors(picture, 2);
    errors.estimate();
    return check_error(world_.impl(), setup, options_, errors, picture, stats_);
  }

  /// What is said of a picture once it is checked.
  BlockErrors::Totals totals(Refinement picture) {
    picture.checked = checked(picture);
    picture.checks = 1;
    BlockErrors errors(picture, 2);
    errors.estimate();
    return errors.totals();
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

/// The check samples about 2048 of 16384 pixels. An eighth of the checked pixels vary, so the
/// root has a relative error of a twentieth or two.
TEST_F(Audits, TellTheTrueError) {
  const BlockErrors::Totals found = totals(picture_);
  const double truth = std::sqrt(true_mean_square());
  EXPECT_GT(found.rmse, truth / 1.25);
  EXPECT_LT(found.rmse, truth * 1.25);
  EXPECT_GT(found.bound, found.rmse);
  EXPECT_LT(found.bound, 1.25 * found.rmse);
}

/// What blocks claim may be too high and too low: either way the check tells.
TEST_F(Audits, CorrectWhatBlocksClaim) {
  const double truth = totals(picture_).rmse;
  for (const float factor : {.3f, .6f, 1.1f}) {
    Refinement wrong = picture_;
    for (std::vector<float>& level : wrong.squares)
      for (float& square : level)
        square *= factor;
    EXPECT_NEAR(totals(wrong).rmse / truth, 1, .15) << factor;
  }
}

/// A picture that is too dark by d has a squared error of d squared. The check counts half of it,
/// computed from the difference between the wrong mean and a right one.
TEST_F(Audits, SeeThroughAPictureThatIsTooDark) {
  constexpr double kDarker = .05;
  const double before = totals(picture_).rmse;
  Refinement dark = picture_;
  const Blocks blocks = dark.blocks();
  for (std::size_t i = 0; i < dark.sums.size(); ++i)
    dark.sums[i] -= static_cast<std::int64_t>(kDarker * kLightUnit *
                                              sample_count(dark, blocks.of_pixel(i / 3)));
  EXPECT_GT(totals(dark).rmse, std::sqrt(before * before + .3 * kDarker * kDarker));
}

/// The next check draws other pixels.
TEST_F(Audits, LookAtOtherPixelsEachTime) {
  const double first = checked(picture_).y;
  Refinement next = picture_;
  ++next.checks;
  EXPECT_NE(checked(next).y, first);
}

/// An error far above what blocks claim needs only a few checked pixels.
TEST_F(Audits, CostLittleWhereTheErrorIsCoarse) {
  const auto samples = [&](double error) {
    options_.refine.error = error;
    const std::uint64_t before = stats_.rays.primary;
    checked(picture_);
    return stats_.rays.primary - before;
  };
  const std::uint64_t all = total_samples(picture_);
  EXPECT_LT(samples(1), all / 100);
  EXPECT_LT(samples(.05), all / 25);
  EXPECT_GT(samples(.02), all / 20);
}

TEST_F(Audits, AreTheSameForAnyNumberOfThreads) {
  const double two = checked(picture_).yy;
  stats_.threads = 1;
  EXPECT_EQ(checked(picture_).yy, two);
}

/// The last samples may reach the requested error without another check.
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
    EXPECT_EQ(stats.error.met, stats.error.rmse_bound <= asked) << asked;
    EXPECT_TRUE(stats.error.met) << asked;
  }
}

TEST(CheckSums, CorrectWithinReason) {
  EXPECT_EQ(CheckSums{}.ratio(), 1) << "no pixel tells";
  EXPECT_EQ((CheckSums{.y = 4, .x = 2}).ratio(), 2);
  EXPECT_EQ((CheckSums{.y = 1e-3, .x = 2}).ratio(), .7);
  EXPECT_EQ((CheckSums{.y = 100, .x = 2}).ratio(), 16);
}

}  // namespace
}  // namespace grelha::test
