// Parts of pixels that get half of the samples.
#include "kernel/shade/pixel_box.hpp"

#include "kernel/shade/strips.hpp"
#include "kernel/shade/workspace.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

/// No box loses anything, and none grows by more than a step; none is named alone where there is
/// none.
TEST(PixelBox, IsKeptInAWord) {
  constexpr float kStep = 1.f / 256;
  Random random(1);
  for (int i = 0; i < 100000; ++i) {
    float at[4];
    for (float& x : at) {
      const float anywhere = static_cast<float>(random.in(-.2, 1.2));
      x = random.chance(.3) ? std::round(256 * anywhere) / 256 : anywhere;
    }
    if (random.chance(.1))
      at[2] = at[0];
    const PixelBox box{at[0], at[1], at[2], at[3]};
    const std::uint32_t word = packed(box);
    if (!(box.x0 <= box.x1 && box.y0 <= box.y1)) {
      EXPECT_EQ(word, 0u);
      continue;
    }
    ASSERT_NE(word, 0u);
    const PixelBox kept = unpacked(word);
    const auto in = [](float x) { return std::clamp(x, 0.f, 1.f); };
    EXPECT_LE(kept.x0, in(box.x0));
    EXPECT_LE(kept.y0, in(box.y0));
    EXPECT_GE(kept.x1, in(box.x1));
    EXPECT_GE(kept.y1, in(box.y1));
    EXPECT_GE(kept.x0, in(box.x0) - kStep);
    EXPECT_GE(kept.y0, in(box.y0) - kStep);
    EXPECT_LE(kept.x1, in(box.x1) + 2 * kStep);
    EXPECT_LE(kept.y1, in(box.y1) + 2 * kStep);
  }
  EXPECT_EQ(packed({1, 0, 0, 1}), 0u);
  EXPECT_NE(packed({0, 0, 0, 0}), 0u);
  EXPECT_NE(packed({0, 0, kStep / 2, kStep / 2}), 0u);
}

constexpr int kSamples = kMostSamples;

/// Looks at one pixel, one unit across at z = 0, with its upper left corner at (0, 0).
Camera one_pixel() {
  Camera c = straight_down(1, 1, 1);
  c.eye = {.5f, -.5f, 1};
  c.at = {.5f, -.5f, 0};
  return c;
}

/// Shines with light 1 in a box of the pixel.
Scene lamp(const PixelBox& box) {
  Scene s = empty_scene();
  s.materials[0].diffuse = {0, 0, 0};
  s.materials[0].emission = {1, 1, 1};
  const Float3 corner[4] = {
      {box.x0, -box.y0, 0}, {box.x1, -box.y0, 0}, {box.x1, -box.y1, 0}, {box.x0, -box.y1, 0}};
  add_triangle(s, corner[0], corner[1], corner[2]);
  add_triangle(s, corner[0], corner[2], corner[3]);
  return s;
}

/// The sums, in units of 1 / kLightUnit, of the parts of the samples of a pixel with a box.
std::vector<std::int64_t> sums(const Variant& variant,
                               const Scene& scene,
                               std::uint32_t box,
                               std::uint32_t seed,
                               std::uint32_t samples = kSamples) {
  const World world(scene, {});
  RenderOptions options;
  options.isa = variant.name;
  options.sampling.samples = kSamples;
  options.sampling.seed = seed;
  const grelha::Setup setup = set_up(world, one_pixel(), options);
  Workspace space(kParts, options.depth, setup.plan);
  std::fill(space.boxes().begin(), space.boxes().end(), box);
  const PixelRun run{0, 0, samples};
  const StripWork work = space.work(options, 0, true, true);
  TraceCounts counts;
  RayCounts rays;
  variant.loops.render_runs(
      world.impl().view, setup.shading, setup.frame, &run, 1, work, counts, rays);
  return space.sums();
}

class PixelBoxes : public EveryVariant {
 protected:
  double sum(const Scene& scene,
             std::uint32_t box,
             std::uint32_t seed,
             std::uint32_t samples = kSamples) const {
    double all = 0;
    const std::vector<std::int64_t> parts = sums(variant(), scene, box, seed, samples);
    for (std::size_t i = 0; i < parts.size(); i += 3)
      all += static_cast<double>(parts[i]) / kLightUnit;
    return all;
  }
};
GRELHA_FOR_EVERY_ISA(PixelBoxes);

PixelBox random_box(Random& random) {
  const auto side = [&](float& lo, float& hi) {
    const float size = static_cast<float>(random.log_in(.005, .5));
    lo = static_cast<float>(random.in(0, 1)) * (1 - size);
    hi = lo + size;
  };
  PixelBox box{};
  side(box.x0, box.x1);
  side(box.y0, box.y1);
  return unpacked(packed(box));
}

/// Each half of the 2^16 samples is a net of 2^15 points. The number of its points in a box differs
/// from the expected number by at most 4 (15 / 2 + 3 / 2) (Niederreiter, 1987, for a box at the
/// corner; any box is a combination of four such boxes). What is seen beside the pixel's box is
/// three boxes of the net at most. Each point weighs twice the area that its half stands for.
TEST_P(PixelBoxes, MoveSamplesWithoutBias) {
  constexpr double kOff = 36;
  Random random(1);
  for (std::uint32_t i = 0; i < 8; ++i) {
    const PixelBox box = random_box(random), seen = random_box(random);
    const double area = double{box.area()};
    EXPECT_NEAR(sum(lamp(box), packed(box), i), area * kSamples, 1) << i;
    EXPECT_NEAR(sum(lamp({-1, -1, 2, 2}), packed(box), i), kSamples, 1) << i;
    EXPECT_NEAR(sum(lamp(seen), packed(box), i),
                double{seen.area()} * kSamples,
                kOff * (2 * area + 3 * 2 * (1 - area)))
        << i;
  }
}

/// Of 64 samples 32 are in the least box, and of the others hardly one.
TEST_P(PixelBoxes, GetHalfOfTheSamples) {
  const std::uint32_t word = packed({.3f, .6f, .3f, .6f});
  const PixelBox box = unpacked(word);
  const double area = double{box.area()}, weight = 2 * area;
  ASSERT_EQ(area, 0x1p-16);
  const Scene s = lamp({box.x0 - 1e-4f, box.y0 - 1e-4f, box.x1 + 1e-4f, box.y1 + 1e-4f});
  EXPECT_NEAR(sum(s, word, 3, 64), 32 * weight, .01 * weight);
}

/// A pixel without one is sampled as ever.
TEST_P(PixelBoxes, LeaveOtherPixelsAlone) {
  EXPECT_NEAR(sum(lamp({.2f, .3f, .6f, .9f}), 0, 5), .24 * kSamples, 72);
  EXPECT_EQ(sum(lamp({-1, -1, 2, 2}), 0, 5), kSamples);
}

TEST_P(PixelBoxes, GiveTheScalarBits) {
  Random random(2);
  const PixelBox box = random_box(random);
  Scene s = lamp({box.x0 - .1f, box.y0 - .1f, box.x1, box.y1});
  s.background = {.25f, .5f, .125f};
  EXPECT_EQ(sums(variant(), s, packed(box), 9), sums(*variants().front(), s, packed(box), 9));
}

}  // namespace
}  // namespace grelha::test
