#pragma once
// Weighted sums of neighbouring pixels, for SSIM and FLIP.

#include <cstddef>
#include <functional>
#include <vector>

namespace grelha {

/// One number a pixel, row by row.
struct Plane {
  int width, height;
  std::vector<double> values;  ///< [height * width]

  /// A plane of zeros.
  Plane(int w, int h) : width(w), height(h), values(std::size_t(w) * std::size_t(h)) {}
  double* row(int y) { return values.data() + std::size_t(y) * std::size_t(width); }
  const double* row(int y) const { return values.data() + std::size_t(y) * std::size_t(width); }
};

/// The weights of adjacent numbers; their count is odd.
using Taps = std::vector<double>;

/// exp(-x^2 / (2 sigma^2)) at -radius to radius.
Taps bell(int radius, double sigma);

double sum(const Taps& taps);

/// Scales taps to a sum of 1.
Taps normalized(Taps taps);

/// Applies a separable filter: `across` within a row times `down` within a column, both with the
/// same number of taps. Only whole windows count, so width and height shrink by the number of taps
/// less one.
Plane filtered(const Plane& plane, const Taps& across, const Taps& down);

/// Calls work(first, end) for strips of rows below `height`, by all threads.
void each_strip(int height, const std::function<void(int first, int end)>& work);

}  // namespace grelha
