// Tests the bytes of a PNG.
#include "frontend/images/image_file.hpp"
#include "frontend/images/tone.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

namespace grelha {
namespace {

std::string noise(std::size_t size) {
  std::string bytes(size, '\0');
  std::uint32_t state = 1;
  for (char& byte : bytes) {
    state = state * 1664525u + 1013904223u;
    byte = char(state >> 24);
  }
  return bytes;
}

/// Returns the least value that is encoded as byte k: the curve of IEC 61966-2-1, rounded to a
/// float.
float limit(int k) {
  const double encoded = (k - .5) / 255;
  return float(encoded <= .04045 ? encoded / 12.92 : std::pow((encoded + .055) / 1.055, 2.4));
}

/// The number of limits that a value has reached.
int byte_by_limits(float value) {
  int byte = 0;
  for (int k = 1; k < 256; ++k)
    byte += value >= limit(k) ? 1 : 0;
  return byte;
}

/// Floats on both sides of every limit, and of every value of their first 16 bits.
TEST(ToByte, IsExactAroundEveryLimit) {
  constexpr std::uint32_t kOne = std::bit_cast<std::uint32_t>(1.f);
  const auto check = [](std::uint32_t bits) {
    const auto value = std::bit_cast<float>(bits);
    ASSERT_EQ(to_byte(value, Tone::srgb), byte_by_limits(value)) << bits;
  };
  for (std::uint32_t first = 1; first <= kOne >> 16; ++first)
    for (const std::uint32_t bits : {(first << 16) - 1, first << 16, (first << 16) + 1})
      check(bits);
  for (int k = 1; k < 256; ++k)
    for (std::uint32_t i = 0; i < 80; ++i)
      check(std::bit_cast<std::uint32_t>(limit(k)) - 40 + i);
}

TEST(ToByte, OfAPictureIsThatOfEachValue) {
  Image image(67, 31);
  for (std::size_t i = 0; i < image.rgb.size(); ++i)
    image.rgb[i] = float(i) / float(image.rgb.size() - 9) * 1.1f - .05f;
  for (const Tone tone : {Tone::authored, Tone::srgb}) {
    const std::vector<std::uint8_t> bytes = to_bytes(image, tone);
    ASSERT_EQ(bytes.size(), image.rgb.size());
    for (std::size_t i = 0; i < bytes.size(); ++i)
      ASSERT_EQ(bytes[i], to_byte(image.rgb[i], tone)) << i;
  }
}

TEST(Png, OfNoiseComesBack) {
  const TemporaryFolder folder;
  Image image(301, 503);
  const std::string values = noise(image.rgb.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    image.rgb[i] = float(std::uint8_t(values[i])) / 255;
  write_image(folder.file("a.png"), image);
  EXPECT_TRUE(read_image(folder.file("a.png")).rgb == image.rgb);
}

}  // namespace
}  // namespace grelha
