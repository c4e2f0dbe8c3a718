#include "frontend/images/compare.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grelha {

namespace {

double distance(float a, float b) {
  const bool same = a == b || (std::isnan(a) && std::isnan(b));
  const double d = std::abs(double(a) - double(b));
  return same ? 0 : std::isnan(d) ? std::numeric_limits<double>::infinity() : d;
}

}  // namespace

Comparison compare(const Image& a, const Image& b) {
  Comparison result;
  result.pixels = std::uint64_t(a.width) * std::uint64_t(a.height);
  double sum = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      double pixel = 0;
      for (int channel = 3 * x; channel < 3 * x + 3; ++channel) {
        const double d = distance(a.row(y)[channel], b.row(y)[channel]);
        sum += d * d;
        pixel = std::max(pixel, d);
      }
      if (pixel > 0)
        ++result.different;
      if (pixel > result.largest) {
        result.largest = pixel;
        result.largest_x = x;
        result.largest_y = y;
      }
    }
  }
  result.rmse = std::sqrt(sum / double(3 * result.pixels));
  return result;
}

Image displayed(Image image) {
  for (float& c : image.rgb)
    c = std::isnan(c) ? c : std::clamp(c, 0.f, 1.f);
  return image;
}

}  // namespace grelha
