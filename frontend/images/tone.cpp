#include "frontend/images/tone.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace grelha {

namespace {

/// By Newton's iteration: std::pow's last bit depends on the machine.
double fifth_root(double a) {
  double root = std::max(a, 1.);  // from above every step comes nearer
  for (int step = 0; step < 64; ++step)
    root -= (root - a / (root * root * root * root)) / 5;
  return root;
}

}  // namespace

double light_of_srgb(double encoded) {
  const double linear = (encoded + 0.055) / 1.055, square = linear * linear;
  return encoded <= 0.04045 ? encoded / 12.92 : square * fifth_root(square);
}

namespace {

/// Byte k begins at thresholds[k - 1]. A table, not a curve per pixel: machines whose powf differ
/// in the last bit would write different files.
using Thresholds = std::array<float, 255>;

Thresholds make_thresholds() {
  Thresholds thresholds;
  for (std::size_t k = 0; k < thresholds.size(); ++k)
    thresholds[k] = float(light_of_srgb((double(k) + 0.5) / 255));
  return thresholds;
}

std::uint8_t srgb_byte(float value) {
  static const Thresholds thresholds = make_thresholds();
  return std::uint8_t(std::ranges::upper_bound(thresholds, value) - thresholds.begin());
}

}  // namespace

std::uint8_t to_byte(float value, Tone tone) {
  if (!(value > 0))
    return 0;
  if (value >= 1)
    return 255;
  return tone == Tone::authored ? std::uint8_t(value * 255 + 0.5f) : srgb_byte(value);
}

std::vector<std::uint8_t> to_bytes(const Image& image, Tone tone) {
  std::vector<std::uint8_t> bytes(image.rgb.size());
  std::ranges::transform(
      image.rgb, bytes.begin(), [tone](float value) { return to_byte(value, tone); });
  return bytes;
}

std::vector<std::uint8_t> to_bytes(const Image& image, Tone tone, const Alpha& alpha) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(4 * alpha.size());
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      bytes.push_back(alpha[i] > 0 ? to_byte(image.rgb[3 * i + c] / alpha[i], tone) : 0);
    bytes.push_back(to_byte(alpha[i], Tone::authored));
  }
  return bytes;
}

Image as_light(Image image, const Encoding& encoding) {
  if (encoding.kind == Encoding::Kind::light)
    return image;
  const bool power = encoding.kind == Encoding::Kind::power;
  for (float& v : image.rgb)
    v = float(power ? std::pow(double(v), 1 / encoding.exponent) : light_of_srgb(v));
  return image;
}

}  // namespace grelha
