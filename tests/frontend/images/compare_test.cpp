#include "frontend/images/compare.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace grelha {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Image image_of(int width, int height, std::vector<float> values) {
  Image image(width, height);
  image.rgb = std::move(values);
  return image;
}

TEST(Compare, EqualPictures) {
  const Image a = image_of(2, 1, {0, 1, 2, 3, 4, 5});
  const Comparison c = compare(a, a);
  EXPECT_EQ(c.rmse, 0);
  EXPECT_EQ(c.largest, 0);
  EXPECT_EQ(c.pixels, 2u);
  EXPECT_EQ(c.different, 0u);
}

/// Differences .5 and .25 in one pixel of two: RMSE sqrt((.25 + .0625) / 6).
TEST(Compare, NumbersWorkedOutByHand) {
  const Comparison c = compare(image_of(1, 2, {0, 0, 0, 0.5f, 0.5f, 0.5f}),
                               image_of(1, 2, {0, 0, 0, 1, 0.25f, 0.5f}));
  EXPECT_DOUBLE_EQ(c.rmse, std::sqrt(0.3125 / 6));
  EXPECT_EQ(c.largest, 0.5);
  EXPECT_EQ(c.largest_x, 0);
  EXPECT_EQ(c.largest_y, 1);
  EXPECT_EQ(c.different, 1u);
}

TEST(Compare, NoNumberNeverPassesForSmall) {
  for (const float odd : {kNan, kInfinity, -kInfinity}) {
    const Image a = image_of(1, 1, {odd, 0, 0}), b = image_of(1, 1, {0, 0, 0});
    EXPECT_EQ(compare(a, b).rmse, std::numeric_limits<double>::infinity());
    EXPECT_EQ(compare(b, a).largest, std::numeric_limits<double>::infinity());
    EXPECT_EQ(compare(a, b).different, 1u);
    EXPECT_EQ(compare(a, a).rmse, 0);
  }
  EXPECT_EQ(
      compare(image_of(1, 1, {kInfinity, 0, 0}), image_of(1, 1, {-kInfinity, 0, 0})).different, 1u);
}

TEST(Compare, ZerosOfBothSignsAreEqual) {
  EXPECT_EQ(compare(image_of(1, 1, {0, 0, 0}), image_of(1, 1, {-0.0f, -0.0f, 0})).different, 0u);
}

/// A light twice as bright as white differs from one a hundred times as bright by nothing a screen
/// shows.
TEST(Displayed, CutsToWhatAScreenShows) {
  const Image a = displayed(image_of(2, 1, {2, 0.25f, -1, kInfinity, -kInfinity, kNan}));
  const Image b = displayed(image_of(2, 1, {100, 0.75f, 0, 1, 0, 0}));
  EXPECT_EQ(std::vector(a.rgb.begin(), a.rgb.end() - 1),
            (std::vector{1.0f, 0.25f, 0.0f, 1.0f, 0.0f}));
  EXPECT_TRUE(std::isnan(a.rgb.back())) << "never passes for a colour";
  EXPECT_EQ(compare(a, b).largest, std::numeric_limits<double>::infinity());
  EXPECT_EQ(
      compare(displayed(image_of(1, 1, {2, 0.25f, -1})), displayed(image_of(1, 1, {100, 0.75f, 0})))
          .largest,
      0.5);
}

}  // namespace
}  // namespace grelha
