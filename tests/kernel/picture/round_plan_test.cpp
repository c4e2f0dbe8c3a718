// What rounds of a refined picture double: what pays within the limits, and blocks drawn for
// checks, which find a picture that is wrong.
#include "kernel/picture/sampling_round.hpp"

#include <cmath>

#include "kernel/picture/refinement.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

constexpr double kAsked = .02;

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

/// A picture that has met its error, and what it was before its limits changed it.
class Checks : public testing::Test {
 protected:
  Checks() : scene_(balls_and_shadows()), world_(scene_, {}) {
    camera_.eye = {0, 0, 20};
    camera_.at = {0, 0, 0};
    camera_.up = {0, 1, 0};
    camera_.angle_deg = 25;
    camera_.width = camera_.height = 128;
    options_.threads = 2;
    options_.refine.error = kAsked;
    options_.refine.refinable = true;
    picture_ = go_on(make_refinement(camera_));
  }

  Refinement go_on(Refinement r) const {
    RenderStats stats;
    EXPECT_TRUE(refine(world_, camera_, options_, r, stats));
    EXPECT_TRUE(stats.error.met);
    return r;
  }

  double true_error(const Refinement& r) const {
    RenderOptions many;
    many.threads = 2;
    many.sampling.samples = 1024;
    many.sampling.seed = 99;
    RenderStats stats;
    const Image truth = render(world_, camera_, many, stats), image = picture_so_far(r);
    double sum = 0;
    for (std::size_t i = 0; i < truth.rgb.size(); ++i)
      sum += std::pow(double(image.rgb[i]) - double(truth.rgb[i]), 2);
    return std::sqrt(sum / static_cast<double>(truth.rgb.size()));
  }

  /// The blocks of a check for this error.
  static std::vector<CheckedBlock> drawn(Refinement r, double error) {
    BlockErrors errors(r, 2);
    errors.estimate();
    RefineOptions asked;
    asked.error = error;
    EXPECT_TRUE(plan_check(r, errors, asked, r.blocks().by_tiles(), {total_samples(r), 1}, 0));
    return r.checking;
  }

  Scene scene_;
  World world_;
  Camera camera_;
  RenderOptions options_;
  Refinement picture_;
};

/// What blocks claim may be too high and too low: either way the check tells.
TEST_F(Checks, CorrectWhatBlocksClaim) {
  for (const float factor : {.2f, .5f, 1.f, 2.f}) {
    Refinement wrong = picture_.before.at(0);
    for (std::vector<float>& level : wrong.squares)
      for (float& square : level)
        square *= factor;
    const double error = true_error(go_on(wrong));
    EXPECT_LE(error, kAsked) << factor;
    EXPECT_GE(error, kAsked / 2) << factor;
  }
}

/// The new half of a block's samples is right, so the difference of the halves shows what is wrong
/// with the old one: also of blocks whose samples agreed.
TEST_F(Checks, SeeThroughAPictureThatIsTooDark) {
  constexpr double kDarker = .08;
  Refinement dark = picture_.before.at(0);
  for (std::size_t i = 0; i < dark.sums.size(); ++i)
    dark.sums[i] -= static_cast<std::int64_t>(kDarker * kLightUnit *
                                              sample_count(dark, dark.blocks().of_pixel(i / 3)));
  EXPECT_LE(true_error(go_on(dark)), 1.3 * kAsked);
}

/// The next check draws other blocks; of an error far above what blocks claim it needs few.
TEST_F(Checks, DrawAsManyBlocksAsTheErrorAsksFor) {
  const std::vector<CheckedBlock> first = drawn(picture_, kAsked);
  Refinement next = picture_;
  ++next.checks;
  const std::vector<CheckedBlock> second = drawn(next, kAsked);
  std::size_t same = 0;
  for (const CheckedBlock& a : first)
    same += std::count_if(
        second.begin(), second.end(), [&](const CheckedBlock& b) { return a.block == b.block; });
  EXPECT_LT(same, first.size() / 2) << "the worst 16, and a few by chance";
  const std::size_t blocks = picture_.log.size();
  double all = 0;
  for (const CheckedBlock& a : first)
    all += static_cast<double>(a.stands_for);
  EXPECT_NEAR(all, static_cast<double>(blocks), 1e-3);
  EXPECT_LT(first.size(), blocks / 8);
  EXPECT_GT(first.size(), blocks / 32);
  EXPECT_LT(drawn(picture_, 1).size(), blocks / 20);
}

TEST(CheckSums, CorrectWithinReason) {
  EXPECT_EQ(CheckSums{}.ratio(), 1) << "no pixel tells";
  EXPECT_EQ((CheckSums{.y = 4, .x = 2}).ratio(), 2);
  EXPECT_EQ((CheckSums{.y = 1e-3, .x = 2}).ratio(), .7);
  EXPECT_EQ((CheckSums{.y = 100, .x = 2}).ratio(), 16);
}

/// A picture of 64 blocks of which some vary, after the first samples.
Refinement uneven() {
  Camera camera;
  camera.width = camera.height = 32;
  Refinement r = make_refinement(camera);
  r.log.assign(r.log.size(), kFirstLog);
  r.rounds = 1;
  r.rays = total_samples(r);
  for (std::size_t b = 0; b < 32; ++b)
    r.blocks().each_pixel(b, [&](std::size_t p) {
      for (std::size_t i = 3 * p; i < 3 * p + 3; ++i) {
        r.squares[0][i] = .01f * static_cast<float>(b);
        r.squares[1][i] = .05f * static_cast<float>(b);
      }
    });
  return r;
}

/// Plans a round of an uneven picture; returns whether there is one.
bool plan(Refinement& r, const RefineOptions& asked) {
  BlockErrors errors(r, 1);
  errors.estimate();
  return plan_round(r, errors, asked, r.blocks().by_tiles(), {total_samples(r), 1});
}

std::uint64_t samples_of_round(const Refinement& r) {
  std::uint64_t samples = 0;
  for (const std::uint32_t b : r.wanted)
    samples += new_count(r, b) * r.blocks().pixels(b);
  return samples;
}

/// The same round whatever is asked for, unless a limit cuts it: then what was there is kept.
TEST(RoundPlan, IsTheSameUntilALimitCutsIt) {
  RefineOptions fine, coarse, few, capped;
  fine.error = 1e-6;
  coarse.error = .05;
  few.samples = 32 * 32 * 8 + 1000;
  capped.error = 1e-6;
  capped.most = 8;
  Refinement whole = uneven();
  EXPECT_TRUE(plan(whole, fine));
  EXPECT_FALSE(whole.limited);
  EXPECT_EQ(whole.limit, Limit::kNone);
  EXPECT_LE(samples_of_round(whole), 3 * total_samples(whole));
  for (const std::uint32_t b : whole.wanted)
    EXPECT_GT(b, 0u) << "it agrees";
  for (RefineOptions asked : {coarse, few}) {
    asked.refinable = true;
    Refinement cut = uneven();
    EXPECT_TRUE(plan(cut, asked));
    EXPECT_TRUE(cut.limited);
    EXPECT_LT(samples_of_round(cut), samples_of_round(whole));
    for (const std::uint32_t b : cut.wanted)
      EXPECT_LE(cut.goal[b], whole.goal[b]) << b;
    EXPECT_TRUE(lift_limits(cut));
    EXPECT_TRUE(plan(cut, fine));
    EXPECT_EQ(cut.goal, whole.goal);
  }
  Refinement cut = uneven();
  EXPECT_TRUE(plan(cut, few));
  EXPECT_LE(samples_of_round(cut), 1000u);
  EXPECT_EQ(cut.limit, Limit::kSamples);
  EXPECT_FALSE(lift_limits(cut)) << "nothing was kept";
  Refinement full = uneven();
  EXPECT_FALSE(plan(full, capped));
  EXPECT_EQ(full.limit, Limit::kSamples);
}

}  // namespace
}  // namespace grelha::test
