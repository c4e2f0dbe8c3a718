#pragma once
// Structural similarity: Wang, Bovik, Sheikh and Simoncelli, "Image quality assessment: from error
// visibility to structural similarity", IEEE Transactions on Image Processing 13 (2004).

#include <optional>

#include "grelha/image.hpp"

namespace grelha {

/// Computes the mean SSIM over all whole windows (11 x 11, Gaussian of sigma 1.5), of the Rec. 601
/// luma of displayed values from 0 to 1. It is 1 for equal pictures, and absent if no window fits.
std::optional<double> ssim(const Image& a, const Image& b);

}  // namespace grelha
