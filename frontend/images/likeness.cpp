#include "frontend/images/likeness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "frontend/images/flip.hpp"
#include "frontend/images/ssim.hpp"

namespace grelha {
namespace {

/// Every fifth entry of the scale "magma" of matplotlib: Smith and van der Walt, 2015, CC0. Between
/// them straight lines are within a 255th of it.
constexpr std::array<std::uint32_t, 52> kMagma{
    0x000004, 0x02020b, 0x050416, 0x090720, 0x0e0b2b, 0x140e36, 0x1a1042, 0x21114e, 0x29115a,
    0x311165, 0x390f6e, 0x420f75, 0x4a1079, 0x52137c, 0x5a167e, 0x621980, 0x6a1c81, 0x721f81,
    0x792282, 0x812581, 0x892881, 0x912b81, 0x992d80, 0xa1307e, 0xaa337d, 0xb2357b, 0xba3878,
    0xc23b75, 0xca3e72, 0xd2426f, 0xd9466b, 0xe04c67, 0xe75263, 0xec5860, 0xf1605d, 0xf4695c,
    0xf7725c, 0xf97b5d, 0xfb8560, 0xfc8e64, 0xfd9869, 0xfea16e, 0xfeaa74, 0xfeb47b, 0xfebd82,
    0xfec68a, 0xfecf92, 0xfed89a, 0xfde2a3, 0xfdebac, 0xfcf4b6, 0xfcfdbf};

float byte(std::uint32_t colour, int channel) {
  return float(colour >> (16 - 8 * channel) & 255) / 255;
}

/// Makes black of every NaN, and returns the pixels that have one in one picture only.
std::vector<std::size_t> without_nans(Image& a, Image& b) {
  std::vector<std::size_t> alone;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const bool nan_a = std::isnan(a.rgb[i]), nan_b = std::isnan(b.rgb[i]);
    if (nan_a != nan_b)
      alone.push_back(i / 3);
    if (nan_a)
      a.rgb[i] = 0;
    if (nan_b)
      b.rgb[i] = 0;
  }
  return alone;
}

}  // namespace

Similarity compare_similarity(Image a, Image b) {
  const std::vector<std::size_t> alone = without_nans(a, b);
  Similarity result{a.width, a.height, {}, {}, flip(a, b)};
  for (const std::size_t pixel : alone)
    result.flip_map[pixel] = 1;
  if (!alone.empty())
    return result;
  result.ssim = ssim(a, b);
  const std::vector<float>& map = result.flip_map;
  result.flip = std::accumulate(map.begin(), map.end(), 0.) / double(map.size());
  return result;
}

Image in_colors(const Similarity& similarity) {
  Image image(similarity.width, similarity.height);
  constexpr int kLast = int(kMagma.size()) - 1;
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    const float at = similarity.flip_map[i / 3] * kLast;
    const int below = std::min(int(at), kLast - 1), channel = int(i % 3);
    const float from = byte(kMagma[std::size_t(below)], channel),
                to = byte(kMagma[std::size_t(below) + 1], channel);
    image.rgb[i] = from + (at - float(below)) * (to - from);
  }
  return image;
}

Image in_numbers(const Similarity& similarity) {
  Image image(similarity.width, similarity.height);
  for (std::size_t i = 0; i < image.rgb.size(); ++i)
    image.rgb[i] = similarity.flip_map[i / 3];
  return image;
}

}  // namespace grelha
