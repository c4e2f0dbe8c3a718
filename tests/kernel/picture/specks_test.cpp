// Specks that shine far brighter than white, over edges that make samples differ.
#include "grelha/render.hpp"

#include <gtest/gtest.h>

#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

constexpr int kSide = 48;         ///< pixels
constexpr double kStripe = 1.37;  ///< pixels
constexpr double kWidth = .02;    ///< pixels, of a speck
constexpr float kShines = 40;
constexpr double kLight[2] = {.1, .3};  ///< of stripes

/// Looks along -z at pixels one unit across at z = 0, the corner of the first at (0, 0).
Camera over_stripes() {
  constexpr float kMiddle = .5f * kSide;
  Camera c = straight_down(kSide, kSide, kSide / 1000.);
  c.eye = {kMiddle, -kMiddle, 1000};
  c.at = {kMiddle, -kMiddle, 0};
  return c;
}

/// A picture whose means are known. Stripes have no blue, specks are white.
struct Stripes {
  Scene scene;
  std::vector<double> mean = std::vector<double>(kSide * kSide);  ///< red, and green
  std::vector<double> blue = mean;

  explicit Stripes(std::uint64_t seed) {
    const auto add_material = [&](float light, float blue_light) {
      Material& m = scene.materials.emplace_back();
      m.diffuse = {0, 0, 0};
      m.emission = {light, light, blue_light};
    };
    for (const double light : kLight)
      add_material(static_cast<float>(light), 0);
    add_material(kShines, kShines);
    for (int i = -1; i < 40; ++i)
      add_stripe(i);
    Random random(seed);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        if (random.chance(.25))
          add_speck(x, y, random);
  }

 private:
  void add_stripe(int i) {
    const float x0 = static_cast<float>(i * kStripe);
    const float x1 = static_cast<float>((i + 1) * kStripe);
    const std::uint32_t m = i & 1;
    add_triangle(scene, {x0, 9, 0}, {x1, 9, 0}, {x1, -99, 0}, m);
    add_triangle(scene, {x0, 9, 0}, {x1, -99, 0}, {x0, -99, 0}, m);
    for (int p = 0; p < kSide * kSide; ++p) {
      const double x = p % kSide;
      const double in = std::min(x + 1, double{x1}) - std::max(x, double{x0});
      mean[static_cast<std::size_t>(p)] += std::max(in, 0.) * kLight[m];
    }
  }
  /// In one stripe and one pixel.
  void add_speck(int x, int y, Random& random) {
    const double px = x + random.in(kWidth, 1 - kWidth);
    const double in_stripe = px / kStripe - std::floor(px / kStripe);
    if (in_stripe < kWidth || in_stripe > 1 - kWidth)
      return;
    const double py = y + random.in(kWidth, 1 - kWidth);
    scene.geometry.spheres.add(
        {static_cast<float>(px), static_cast<float>(-py), 0}, static_cast<float>(.5 * kWidth), 2);
    const double area = std::numbers::pi / 4 * kWidth * kWidth;
    const auto p = static_cast<std::size_t>(y * kSide + x);
    mean[p] += area * (double{kShines} - kLight[static_cast<int>(px / kStripe) & 1]);
    blue[p] = area * double{kShines};
  }
};

/// A speck adds .0126 to its pixel. There is one in four pixels, so missing all of the specks would
/// give an error of .006. A speck covers .13 of its box, which gets at least 30 samples. Random
/// samples would miss one speck in a hundred; the samples of a net miss less than half as many.
TEST(Specks, AreMissedNowhere) {
  constexpr double kAsked = .003;
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    const Stripes stripes(100 * seed);
    const World world(stripes.scene, {});
    RenderOptions options;
    options.refine.error = kAsked;
    options.sampling.seed = seed;
    RenderStats stats;
    const Image image = render(world, over_stripes(), options, stats);
    double squares = 0;
    int specks = 0;
    int missed = 0;
    for (std::size_t p = 0; p < stripes.mean.size(); ++p) {
      for (std::size_t c = 0; c < 3; ++c) {
        const double off = double{image.rgb[3 * p + c]} - (c == 2 ? stripes.blue : stripes.mean)[p];
        squares += off * off;
      }
      specks += stripes.blue[p] > 0;
      missed += stripes.blue[p] > 0 && !(image.rgb[3 * p + 2] > 0);
    }
    EXPECT_LE(std::sqrt(squares / (3 * kSide * kSide)), kAsked) << seed;
    EXPECT_GT(specks, 400) << seed;
    EXPECT_LE(missed, specks / 200) << seed;
  }
}

}  // namespace
}  // namespace grelha::test
