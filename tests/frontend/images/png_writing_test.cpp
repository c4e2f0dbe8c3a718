// Tests the optimisations of the PNG writer: strips compressed in parallel, and bytes looked up by
// the leading bits of a float. A part of image_file_test.
#include "frontend/images/image_file.hpp"
#include "frontend/images/strip_deflate.hpp"
#include "frontend/images/tone.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gtest/gtest.h>
#include <omp.h>
#include <zlib.h>

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

/// Half noise, half repetitions, from as far back as a stream may refer.
std::string some_bytes(std::size_t size) {
  std::string bytes;
  std::uint32_t state = 1;
  while (bytes.size() < size) {
    state = state * 1664525u + 1013904223u;
    const std::size_t far = 1 + (state >> 8) % 32768;
    if (state >> 31 && far < bytes.size())
      bytes += bytes.substr(bytes.size() - far, 1 + far % 300);
    else
      bytes += char(state >> 16);
  }
  bytes.resize(size);
  return bytes;
}

std::string inflated(const std::string& stream, std::size_t size) {
  std::string out(size + 1, '\0');
  uLongf length = uLongf(out.size());
  const int result = uncompress(reinterpret_cast<Bytef*>(out.data()),
                                &length,
                                reinterpret_cast<const Bytef*>(stream.data()),
                                uLong(stream.size()));
  EXPECT_EQ(result, Z_OK);
  out.resize(length);
  return out;
}

TEST(StripDeflate, ComesBackByZlib) {
  for (const std::size_t size : {std::size_t(0),
                                 std::size_t(1),
                                 kStripBytes - 1,
                                 kStripBytes,
                                 kStripBytes + 1,
                                 2 * kStripBytes,
                                 9 * kStripBytes + 17}) {
    const std::string bytes = some_bytes(size);
    for (const int level : {0, 1, 4, 9})
      EXPECT_TRUE(inflated(deflate_in_strips(bytes, level), size) == bytes) << size << ' ' << level;
  }
}

/// Bytes that no strip before has seen would take themselves again in each.
TEST(StripDeflate, StripsReferToThoseBefore) {
  std::string bytes = noise(20000);
  while (bytes.size() < 8 * kStripBytes)
    bytes += bytes.substr(bytes.size() - 20000);
  const std::size_t once = deflate_in_strips(noise(20000), 4).size();
  EXPECT_LT(deflate_in_strips(bytes, 4).size(), once + bytes.size() / 50);
}

TEST(StripDeflate, BytesAreThoseOfAnyThreads) {
  const std::string bytes = some_bytes(7 * kStripBytes + 5);
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const std::string alone = deflate_in_strips(bytes, 4);
  for (const int threads : {2, 5}) {
    omp_set_num_threads(threads);
    EXPECT_TRUE(deflate_in_strips(bytes, 4) == alone) << threads;
  }
  omp_set_num_threads(before);
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

TEST(Png, OfManyStripsComesBack) {
  const TemporaryFolder folder;
  Image image(301, 503);
  const std::string values = noise(image.rgb.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    image.rgb[i] = float(std::uint8_t(values[i])) / 255;
  write_image(folder.file("a.png"), image);
  ASSERT_GT(folder.read("a.png").size(), 3 * kStripBytes);
  EXPECT_TRUE(read_image(folder.file("a.png")).rgb == image.rgb);
}

}  // namespace
}  // namespace grelha
