#include "frontend/images/png_chunks.hpp"

#include <zlib.h>

#include <cstdint>
#include <numeric>

namespace grelha {
namespace {

constexpr std::size_t kSignature = 8, kLength = 4, kType = 4, kCrc = 4;
constexpr std::size_t kHeaderEnd =
    kSignature + kLength + kType + 13 + kCrc;  ///< of IHDR, which comes first

std::string big_endian(std::uint32_t value) {
  return {char(value >> 24), char(value >> 16 & 0xff), char(value >> 8 & 0xff), char(value & 0xff)};
}

std::uint32_t big_endian(std::string_view bytes) {
  const std::string_view four = bytes.substr(0, 4);
  const auto append = [](std::uint32_t value, char b) { return value << 8 | std::uint8_t(b); };
  return std::accumulate(four.begin(), four.end(), std::uint32_t{0}, append);
}

std::string chunk(const std::string& type, const std::string& data) {
  const std::string body = type + data;
  const uLong checksum = crc32(0, reinterpret_cast<const Bytef*>(body.data()), uInt(body.size()));
  return big_endian(std::uint32_t(data.size())) + body + big_endian(std::uint32_t(checksum));
}

}  // namespace

std::string with_chunks(const std::string& png, Tone tone, const Notes& notes) {
  const std::string perceptual(1, '\0');  // the rendering intent: what pictures are shown with
  std::string chunks = tone == Tone::srgb ? chunk("sRGB", perceptual) : "";
  for (const auto& [key, text] : notes)
    chunks += chunk("tEXt", key + '\0' + text);
  return png.substr(0, kHeaderEnd) + chunks + png.substr(kHeaderEnd);
}

Encoding png_encoding(std::string_view png) {
  constexpr double kGammaUnit = 100000;
  Encoding found;
  std::size_t at = kSignature;
  while (at + kLength + kType <= png.size()) {
    const std::size_t size = big_endian(png.substr(at));
    const std::string_view type = png.substr(at + kLength, kType),
                           data = png.substr(at + kLength + kType).substr(0, size);
    if (type == "sRGB")
      return {Encoding::Kind::srgb, 1};
    if (type == "gAMA" && data.size() == 4 && big_endian(data) > 0)
      found = {Encoding::Kind::power, big_endian(data) / kGammaUnit};
    if (type == "IDAT")
      break;
    at += kLength + kType + size + kCrc;
  }
  return found;
}

}  // namespace grelha
