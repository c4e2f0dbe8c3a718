#include "frontend/images/hdr_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace grelha {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

constexpr int kMantissa = 8, kExponentBias = 128;
constexpr float kMinValue = 1e-38f, kMaxValue = 1e38f;  ///< range of the shared exponent
constexpr int kLeastPacked = 8, kMostPacked = 32767;    ///< widths of rows that may be packed
constexpr int kLongestRun = 127, kLongestDump = 128, kWorthARun = 4;

float light(float value) {
  return value > 0 ? std::min(value, kMaxValue) : 0;
}  // a NaN is none

/// To the nearest mantissa: cut off, a picture would lose a quarter of a percent of its light.
Rgbe shared_exponent(const float* rgb) {
  const float r = light(rgb[0]), g = light(rgb[1]), b = light(rgb[2]);
  const float most = std::max({r, g, b});
  if (most < kMinValue)
    return {};
  int exponent = 0;
  std::frexp(most, &exponent);
  const auto mantissa = [&](float value) {
    return std::lround(std::ldexp(value, kMantissa - exponent));
  };
  if (mantissa(most) == 1 << kMantissa)
    ++exponent;
  const auto byte = [&](float value) { return std::uint8_t(mantissa(value)); };
  return {byte(r), byte(g), byte(b), std::uint8_t(exponent + kExponentBias)};
}

/// One component of a row: runs of equal bytes, and dumps of others between them.
void pack(const std::vector<std::uint8_t>& row, std::string& bytes) {
  const std::size_t size = row.size();
  const auto run_at = [&](std::size_t i) {
    std::size_t n = 1;
    while (i + n < size && n < kLongestRun && row[i + n] == row[i])
      ++n;
    return n;
  };
  std::size_t at = 0;
  while (at < size) {
    const std::size_t run = run_at(at);
    if (run >= kWorthARun) {
      bytes += char(kLongestDump + run);
      bytes += char(row[at]);
      at += run;
      continue;
    }
    std::size_t end = at;
    while (end < size && end - at < kLongestDump && run_at(end) < kWorthARun)
      ++end;
    bytes += char(end - at);
    bytes.append(row.begin() + std::ptrdiff_t(at), row.begin() + std::ptrdiff_t(end));
    at = end;
  }
}

bool is_packed(int width) {
  return width >= kLeastPacked && width <= kMostPacked;
}

void append_row(const float* rgb, int width, std::string& bytes) {
  const bool packed = is_packed(width);
  std::array<std::vector<std::uint8_t>, 4> components;
  for (int x = 0; x < width; ++x) {
    const Rgbe pixel = shared_exponent(rgb + 3 * x);
    if (!packed)
      bytes.append(pixel.begin(), pixel.end());
    for (std::size_t i = 0; packed && i < pixel.size(); ++i)
      components[i].push_back(pixel[i]);
  }
  if (!packed)
    return;
  bytes += {2, 2, char(width >> 8), char(width & 0xff)};
  for (const auto& component : components)
    pack(component, bytes);
}

}  // namespace

std::string encode_hdr(const Image& image, const Notes& notes) {
  std::string bytes = "#?RADIANCE\n";
  for (const auto& [key, text] : notes)
    bytes += "# " + key + ": " + text + '\n';
  bytes += "FORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(image.height) + " +X " +
           std::to_string(image.width) + '\n';
  for (int y = 0; y < image.height; ++y)
    append_row(image.row(y), image.width, bytes);
  return bytes;
}

}  // namespace grelha
