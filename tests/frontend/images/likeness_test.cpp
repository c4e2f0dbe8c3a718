#include "frontend/images/likeness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "frontend/images/tone.hpp"

namespace grelha {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Image uniform(int width, int height, float r, float g, float b) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    image.rgb[i] = r;
    image.rgb[i + 1] = g;
    image.rgb[i + 2] = b;
  }
  return image;
}

/// Noise with a box in it.
Image noisy(int width, int height, std::uint32_t seed) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    seed = seed * 1664525 + 1013904223;
    image.rgb[i] = float(seed >> 8) / float(1 << 24) * (i % 7 < 3 ? 1.f : .5f);
  }
  return image;
}

Image transposed(const Image& image) {
  Image result(image.height, image.width);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      std::copy_n(image.row(y) + 3 * x, 3, result.row(x) + 3 * y);
  return result;
}

TEST(Similarity, EqualPictures) {
  const Image a = noisy(20, 70, 1);
  const Similarity l = compare_similarity(a, a);
  EXPECT_EQ(l.ssim, 1);
  EXPECT_EQ(l.flip, 0);
  EXPECT_EQ(l.flip_map, std::vector<float>(20 * 70));
}

/// Means 0 and 1, no variance: C1 / (1 + C1) is left of SSIM. The colours lie 100 apart in L*,
/// no feature is there. FLIP takes 100^.7 = 25.119. Green and blue lie 203.302 apart, the largest
/// distance: 203.302^.7 = 41.276. So FLIP is .95 + .05 (25.119 - .4 41.276) / (.6 41.276).
TEST(Similarity, BlackAgainstWhiteByHand) {
  const Similarity l = compare_similarity(uniform(12, 12, 0, 0, 0), uniform(12, 12, 1, 1, 1));
  EXPECT_NEAR(l.ssim.value_or(0), 1e-4 / 1.0001, 1e-15);
  EXPECT_NEAR(l.flip.value_or(0), .96738, 5e-6);
}

TEST(Similarity, GreenAndBlueAreFarthestApart) {
  EXPECT_NEAR(
      compare_similarity(uniform(9, 5, 0, 1, 0), uniform(9, 5, 0, 0, 1)).flip.value_or(0), 1, 1e-6);
}

TEST(Similarity, SsimNeedsAWholeWindow) {
  EXPECT_TRUE(compare_similarity(noisy(11, 11, 1), noisy(11, 11, 2)).ssim);
  for (const auto& [width, height] : {std::pair{10, 40}, {40, 10}, {1, 1}}) {
    const Similarity l = compare_similarity(noisy(width, height, 1), noisy(width, height, 2));
    EXPECT_FALSE(l.ssim);
    EXPECT_GT(l.flip.value_or(0), 0);
  }
}

/// Rows are filtered in strips, columns are not.
TEST(Similarity, IsTheSameOfRowsAndColumns) {
  const Image a = noisy(15, 150, 1), b = noisy(15, 150, 2);
  const Similarity upright = compare_similarity(a, b),
                   lying = compare_similarity(transposed(a), transposed(b));
  EXPECT_NEAR(upright.ssim.value_or(0), lying.ssim.value_or(1), 1e-13);
  for (int y = 0; y < 150; ++y)
    for (int x = 0; x < 15; ++x)
      EXPECT_NEAR(
          upright.flip_map[std::size_t(15 * y + x)], lying.flip_map[std::size_t(150 * x + y)], 1e-6)
          << x << ' ' << y;
}

TEST(Similarity, NoNumberIsNoColour) {
  Image a = noisy(20, 20, 1), b = noisy(20, 20, 2);
  const double before = compare_similarity(a, b).flip.value_or(0);
  a.rgb[3 * 50 + 1] = b.rgb[3 * 50 + 1] = kNan;
  EXPECT_NEAR(compare_similarity(a, b).flip.value_or(1), before, .05) << "in both: no difference";
  EXPECT_TRUE(compare_similarity(a, b).ssim);
  EXPECT_EQ(compare_similarity(a, a).flip, 0);
  for (const bool in_a : {true, false}) {
    Image odd = a;
    odd.rgb[3 * 70] = kNan;
    const Similarity l = in_a ? compare_similarity(odd, a) : compare_similarity(a, odd);
    EXPECT_FALSE(l.ssim) << "never passes for alike";
    EXPECT_FALSE(l.flip);
    EXPECT_EQ(l.flip_map[70], 1);
    EXPECT_EQ(std::ranges::count_if(l.flip_map, [](float v) { return std::isnan(v); }), 0);
  }
}

Similarity of_map(std::vector<float> map) {
  return {int(map.size()), 1, {}, {}, std::move(map)};
}

/// The ends of magma and its entries 64, 128 and 200 of 256.
TEST(ErrorMap, IsMagmaToTheNextByte) {
  const Image picture = in_colors(of_map({0, 64 / 255.f, 128 / 255.f, 200 / 255.f, 1}));
  const std::vector<std::uint8_t> bytes = to_bytes(picture, Tone::authored);
  const std::vector<int> magma{0, 0, 4, 81, 18, 124, 183, 55, 121, 253, 152, 105, 252, 253, 191};
  ASSERT_EQ(bytes.size(), magma.size());
  for (std::size_t i = 0; i < magma.size(); ++i)
    EXPECT_NEAR(bytes[i], magma[i], i < 3 || i >= 12 ? 0 : 1) << i;
}

TEST(ErrorMap, GrowsBrighterBySmallSteps) {
  std::vector<float> map(256);
  for (std::size_t i = 0; i < map.size(); ++i)
    map[i] = float(i) / 255;
  const Image picture = in_colors(of_map(map));
  const auto luma = [](const float* c) { return .299f * c[0] + .587f * c[1] + .114f * c[2]; };
  for (const float* c = picture.row(0); c < picture.row(0) + 3 * 255; c += 3) {
    EXPECT_GT(luma(c + 3), luma(c));
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_LT(std::abs(c[channel + 3] - c[channel]), 2.5 / 255) << c - picture.row(0);
  }
}

TEST(ErrorMap, HasItsNumbersInEachChannel) {
  EXPECT_EQ(in_numbers(of_map({.25f, 1})).rgb, (std::vector<float>{.25f, .25f, .25f, 1, 1, 1}));
}

TEST(Srgb, IsLightThereAndBack) {
  Image ramp(86, 1);
  for (std::size_t i = 0; i < ramp.rgb.size(); ++i)
    ramp.rgb[i] = float(i) / float(ramp.rgb.size() - 1);
  const Image back = as_srgb(as_light(ramp, {.kind = Encoding::Kind::srgb}));
  for (std::size_t i = 0; i < ramp.rgb.size(); ++i)
    EXPECT_NEAR(back.rgb[i], ramp.rgb[i], 1e-6) << i;
  EXPECT_NEAR(as_srgb(uniform(1, 1, .5f, 0, 1)).rgb[0] * 255, 188, .5) << "middle grey of light";
}

}  // namespace
}  // namespace grelha
