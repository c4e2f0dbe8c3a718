// How many samples a picture still takes, as far as the first of them tell.
#include "kernel/adaptive/foreseen_samples.hpp"

#include <gtest/gtest.h>

#include "kernel/adaptive/adaptive_sampler.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

constexpr int kFirstLog = 2;

std::uint64_t samples_of(const Refinement& r) {
  std::uint64_t sum = 0;
  for (std::size_t p = 0; p < r.log.size(); ++p)
    sum += sample_count(r, p);
  return sum;
}

/// Between a quarter and one and a half of them, from a picture that is five times as far off. None
/// where the error is met.
TEST(ForeseenSamples, AreOfTheOrderOfThoseTaken) {
  for (const std::uint64_t seed : {5u, 6u, 7u}) {
    Scene scene = random_spheres(seed, 300);
    scene.lights.push_back({{3, 4, 5}, {1, 1, 1}});
    const World world(scene, {});
    Camera camera;
    camera.eye = {2.5f, 2, 3};
    camera.at = {0, 0, 0};
    camera.width = camera.height = 48;
    RenderOptions options;
    RenderStats stats;
    options.refine.error = .03;
    Refinement picture = make_refinement(camera);
    ASSERT_TRUE(refine(world, camera, options, picture, stats));
    PixelErrors errors(picture, false, kFirstLog, 1);
    errors.judge();
    EXPECT_EQ(foreseen_samples(picture, errors, .03), 0);
    const double foreseen = foreseen_samples(picture, errors, .006);
    const std::uint64_t before = samples_of(picture);
    options.refine.error = .006;
    picture.finished = picture.met = false;
    ASSERT_TRUE(refine(world, camera, options, picture, stats));
    const double taken = static_cast<double>(samples_of(picture) - before);
    EXPECT_GT(foreseen, taken / 4) << seed;
    EXPECT_LT(foreseen, taken * 1.5) << seed;
  }
}

}  // namespace
}  // namespace grelha::test
