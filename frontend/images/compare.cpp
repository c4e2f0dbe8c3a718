#include "frontend/images/compare.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grelha {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double distance(float a, float b) {
  const bool same = a == b || (std::isnan(a) && std::isnan(b));
  const double d = std::abs(double(a) - double(b));
  return same ? 0 : std::isnan(d) ? kInfinity : d;
}

/// The square of a difference, relative to the square of the reference colour.
double relative_square(double distance, float reference) {
  constexpr double kDark = .01;                // no less counts as the square of a colour
  if (distance == 0 || distance == kInfinity)  // the reference may be no number
    return distance;
  return distance * distance / (double(reference) * reference + kDark);
}

}  // namespace

Comparison compare(const Image& a, const Image& b) {
  Comparison result;
  result.pixels = std::uint64_t(a.width) * std::uint64_t(a.height);
  double sum = 0, relative = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      double pixel = 0;
      for (int channel = 3 * x; channel < 3 * x + 3; ++channel) {
        const double d = distance(a.row(y)[channel], b.row(y)[channel]);
        sum += d * d;
        relative += relative_square(d, b.row(y)[channel]);
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
  const double channels = double(3 * result.pixels);
  result.rmse = std::sqrt(sum / channels);
  result.relative_mse = relative / channels;
  result.psnr_db = result.rmse > 0 ? -20 * std::log10(result.rmse) : kInfinity;
  return result;
}

Image displayed(Image image) {
  for (float& c : image.rgb)
    c = std::isnan(c) ? c : std::clamp(c, 0.f, 1.f);
  return image;
}

Image difference(const Image& a, const Image& b, double scale) {
  Image image(a.width, a.height);
  const auto scaled = [scale](float x, float y) { return float(distance(x, y) * scale); };
  std::ranges::transform(a.rgb, b.rgb, image.rgb.begin(), scaled);
  return image;
}

}  // namespace grelha
