#include "frontend/images/tone.hpp"

#include <omp.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>

#include "kernel/base/pages.hpp"
#include "kernel/base/parallel_for.hpp"

namespace grelha {

double light_of_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

namespace {

/// Byte k begins at thresholds[k - 1]; the entry behind the last one is beyond all values. A table,
/// not a curve per pixel: two machines whose powf differ in the last bit would otherwise write
/// different files.
using Thresholds = std::array<float, 256>;

Thresholds make_thresholds() {
  Thresholds thresholds;
  for (std::size_t k = 1; k < thresholds.size(); ++k)
    thresholds[k - 1] = float(light_of_srgb((double(k) - 0.5) / 255));
  thresholds.back() = std::numeric_limits<float>::infinity();
  return thresholds;
}

/// The bytes of floats from 0 to 1. Their first 16 bits say which byte the least float with these
/// begins at; it is that one or the next, as thresholds are further apart than such floats.
class SrgbBytes {
 public:
  SrgbBytes() : thresholds_(make_thresholds()) {
    const auto end = thresholds_.end() - 1;
    for (std::uint32_t i = 0; i < kStarts; ++i)
      starts_[i] = std::uint8_t(
          std::upper_bound(thresholds_.begin(), end, std::bit_cast<float>(i << kDroppedBits)) -
          thresholds_.begin());
  }
  std::uint8_t of(float value) const {
    const std::uint8_t start = starts_[std::bit_cast<std::uint32_t>(value) >> kDroppedBits];
    return std::uint8_t(start + (value >= thresholds_[start] ? 1 : 0));
  }

 private:
  static constexpr int kDroppedBits = 16;
  static constexpr std::uint32_t kStarts = std::bit_cast<std::uint32_t>(1.f) >> kDroppedBits;

  Thresholds thresholds_;
  std::array<std::uint8_t, kStarts> starts_;
};

const SrgbBytes& srgb_bytes() {
  static const SrgbBytes table;
  return table;
}

}  // namespace

std::uint8_t to_byte(float value, Tone tone) {
  if (!(value > 0))
    return 0;
  if (value >= 1)
    return 255;
  return tone == Tone::authored ? std::uint8_t(value * 255 + 0.5f) : srgb_bytes().of(value);
}

std::vector<std::uint8_t> to_bytes(const Image& image, Tone tone) {
  auto bytes = array_to_fill<std::vector<std::uint8_t>>(image.rgb.size());
  constexpr std::size_t kEach = std::size_t(1) << 16;
  each_turn((bytes.size() + kEach - 1) / kEach, omp_get_max_threads(), [&](std::size_t part) {
    const std::size_t end = std::min((part + 1) * kEach, bytes.size());
    for (std::size_t i = part * kEach; i < end; ++i)
      bytes[i] = to_byte(image.rgb[i], tone);
  });
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
