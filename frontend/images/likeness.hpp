#pragma once

#include <optional>
#include <vector>

#include "grelha/image.hpp"

namespace grelha {

/// How alike two pictures look on a screen. Pixels that are NaN in both are no difference.
struct Similarity {
  int width, height;
  /// 1 for equal pictures; absent where a NaN is in one picture only, or no window fits
  std::optional<double> ssim;
  /// mean of the map; absent where a NaN is in one picture only
  std::optional<double> flip;
  std::vector<float> flip_map;  ///< [height * width] from 0 to 1, which is also such a pixel's
};

/// Pictures hold sRGB values from 0 to 1, or NaN.
Similarity compare_similarity(Image a, Image b);

/// The map as a picture: from black for 0 by violet and orange to pale yellow for 1.
Image in_colors(const Similarity& similarity);

/// The map in each channel.
Image in_numbers(const Similarity& similarity);

}  // namespace grelha
