#pragma once

#include <cstdint>

#include "grelha/image.hpp"

namespace grelha {

/// How far two pictures of one size lie apart, over all channels of all pixels. Equal infinities
/// and a NaN in both are no difference. A NaN or an infinity in one picture only is an infinite
/// difference, so it can never pass for small.
struct Comparison {
  double rmse = 0;
  double largest = 0;  ///< of the differences between channels
  int largest_x = 0, largest_y = 0;
  std::uint64_t pixels = 0, different = 0;
};

Comparison compare(const Image& a, const Image& b);

/// Clamps every channel to 0 to 1, as a screen does, infinities too. A NaN stays a NaN.
Image displayed(Image image);

}  // namespace grelha
