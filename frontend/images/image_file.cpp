#include "frontend/images/image_file.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <numeric>
#include <sstream>
#include <vector>

#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

#include "frontend/files/atomic_file.hpp"
#include "frontend/files/parse_error.hpp"
#include "frontend/images/hdr_file.hpp"
#include "frontend/images/tone.hpp"

#include <zlib.h>

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

/// `png` with an sRGB chunk, when that is its tone, and one tEXt chunk a note, before the pixels.
std::string with_chunks(const std::string& png, Tone tone, const Notes& notes) {
  const std::string perceptual(1, '\0');  // the rendering intent: what pictures are shown with
  std::string chunks = tone == Tone::srgb ? chunk("sRGB", perceptual) : "";
  for (const auto& [key, text] : notes)
    chunks += chunk("tEXt", key + '\0' + text);
  return png.substr(0, kHeaderEnd) + chunks + png.substr(kHeaderEnd);
}

}  // namespace

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

namespace {

constexpr std::int64_t kStbBytes = 2'000'000'000;  // stb counts bytes in an int
constexpr int kMaxSide = 65536;

void append(void* bytes, void* data, int size) {
  static_cast<std::string*>(bytes)->append(static_cast<const char*>(data), std::size_t(size));
}

std::string read_bytes(const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  // << takes an empty file for a failure
  if (file.peek() != std::ifstream::traits_type::eof())
    bytes << file.rdbuf();
  if (!file.is_open() || file.bad() || !bytes)
    throw FileError(path,
                    std::string(file.is_open() ? "cannot read: " : "cannot open: ") +
                        std::strerror(errno ? errno : EIO));
  return std::move(bytes).str();
}

float swap_bytes(float value) {
  return std::bit_cast<float>(__builtin_bswap32(std::bit_cast<std::uint32_t>(value)));
}

/// The words of a PFM header: kind, width, height, scale; one white space after each.
class PfmHeader {
 public:
  PfmHeader(const std::string& path, const std::string& bytes) : path_(path), bytes_(bytes) {
    const std::string kind = word();
    if (kind != "PF" && kind != "Pf")
      reject("expected PF or Pf at the start");
    channels = kind == "PF" ? 3 : 1;
    width = side();
    height = side();
    const std::string text = word();
    double scale = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), scale);
    if (error != std::errc() || end != text.data() + text.size() || scale == 0)
      reject("the scale is no number but 0");
    big_endian = scale > 0;
  }

  [[noreturn]] void reject(const char* what) const {
    throw FileError(path_, std::string("not a PFM picture: ") + what);
  }

  int channels, width, height;
  bool big_endian;
  std::size_t data = 0;  ///< where the floats begin

 private:
  std::string word() {
    const std::size_t end = bytes_.find_first_of(" \t\r\n", data);
    if (end == std::string::npos)
      reject("the header ends early");
    std::string text = bytes_.substr(data, end - data);
    data = end + 1;
    return text;
  }

  int side() {
    const std::string text = word();
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 1 || value > kMaxSide)
      reject("width and height must be 1 to 65536");
    return value;
  }

  const std::string& path_;
  const std::string& bytes_;
};

Image read_pfm(const std::string& path, const std::string& bytes) {
  const PfmHeader header(path, bytes);
  const std::size_t row = std::size_t(header.width) * std::size_t(header.channels);
  if ((bytes.size() - header.data) / sizeof(float) / row < std::size_t(header.height))
    header.reject("too few floats");
  Image image(header.width, header.height);
  const bool swap = header.big_endian != (std::endian::native == std::endian::big);
  for (int y = 0; y < image.height; ++y) {
    const char* from =
        bytes.data() + header.data + std::size_t(image.height - 1 - y) * row * sizeof(float);
    for (int i = 0; i < 3 * image.width; ++i) {
      float value;
      std::memcpy(&value,
                  from + std::size_t(header.channels == 3 ? i : i / 3) * sizeof value,
                  sizeof value);
      image.row(y)[i] = swap ? swap_bytes(value) : value;
    }
  }
  return image;
}

template <class T>
using StbPixels = std::unique_ptr<T, void (*)(void*)>;

/// Of three channels a pixel, or four.
template <class T>
Image from_stb(const std::string& path,
               StbPixels<T> pixels,
               int width,
               int height,
               int channels,
               float white) {
  if (!pixels)
    throw FileError(path, std::string("cannot read the picture: ") + stbi_failure_reason());
  Image image(width, height);
  const T* from = pixels.get();
  for (std::size_t i = 0; i < image.rgb.size(); i += 3, from += channels) {
    if (channels == 4 && float(from[3]) != white)
      throw FileError(path, kTransparent);
    for (std::size_t c = 0; c < 3; ++c)
      image.rgb[i + c] = float(from[c]) / white;
  }
  return image;
}

/// .png and .hdr
Image read_by_stb(const std::string& path, const std::string& bytes, ImageFormat format) {
  if (bytes.size() > std::size_t(kStbBytes))
    throw FileError(path, "the picture is too large");
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const int size = int(bytes.size());
  int w = 0, h = 0, channels = 0;
  stbi_info_from_memory(data, size, &w, &h, &channels);
  const int read = channels == 2 || channels == 4 ? 4 : 3;
  if (format == ImageFormat::hdr) {
    if (!stbi_is_hdr_from_memory(data, size))
      throw FileError(path, "not a Radiance picture");
    StbPixels<float> pixels(stbi_loadf_from_memory(data, size, &w, &h, &channels, read),
                            stbi_image_free);
    return from_stb(path, std::move(pixels), w, h, read, 1);
  }
  if (bytes.compare(0, 4, "\x89PNG") != 0)
    throw FileError(path, "not a PNG picture");
  if (stbi_is_16_bit_from_memory(data, size)) {
    StbPixels<stbi_us> pixels(stbi_load_16_from_memory(data, size, &w, &h, &channels, read),
                              stbi_image_free);
    return from_stb(path, std::move(pixels), w, h, read, 65535);
  }
  StbPixels<stbi_uc> pixels(stbi_load_from_memory(data, size, &w, &h, &channels, read),
                            stbi_image_free);
  return from_stb(path, std::move(pixels), w, h, read, 255);
}

}  // namespace

std::optional<ImageFormat> image_format(std::string_view path) {
  if (path.size() < 4)
    return {};
  std::string ending(path.substr(path.size() - 3));
  for (char& c : ending)
    if (c >= 'A' && c <= 'Z')
      c = char(c - 'A' + 'a');
  const auto found = std::ranges::find(kImageFormats, ending, &FormatName::first);
  if (path[path.size() - 4] != '.' || found == kImageFormats.end())
    return {};
  return found->second;
}

std::string_view ending_of(ImageFormat format) {
  return std::ranges::find(kImageFormats, format, &FormatName::second)->first;
}

bool image_fits(ImageFormat format, int width, int height, int channels) {
  const bool in_range = width >= 1 && height >= 1 && width <= kMaxSide && height <= kMaxSide;
  const bool by_stb = format == ImageFormat::png || format == ImageFormat::hdr;
  return in_range && (!by_stb || (channels * std::int64_t(width) + 1) * height <= kStbBytes);
}

std::string encode_png(
    std::span<const std::uint8_t> pixels, int width, int height, Tone tone, const Notes& notes) {
  const int row = int(pixels.size() / std::size_t(height));
  std::string bytes;
  if (!stbi_write_png_to_func(append, &bytes, width, height, row / width, pixels.data(), row))
    throw std::bad_alloc();
  return with_chunks(bytes, tone, notes);
}

std::string encode_png(const Image& image, Tone tone, const Notes& notes, const Alpha& alpha) {
  const std::vector<std::uint8_t> pixels =
      alpha.empty() ? to_bytes(image, tone) : to_bytes(image, tone, alpha);
  return encode_png(pixels, image.width, image.height, tone, notes);
}

std::string encode_pfm(const Image& image) {
  std::string bytes =
      "PF\n" + std::to_string(image.width) + ' ' + std::to_string(image.height) + "\n-1.0\n";
  bytes.reserve(bytes.size() + image.rgb.size() * sizeof(float));
  for (int y = image.height - 1; y >= 0; --y)
    for (int i = 0; i < 3 * image.width; ++i) {
      const float value = image.row(y)[i];
      const float little = std::endian::native == std::endian::little ? value : swap_bytes(value);
      bytes.append(reinterpret_cast<const char*>(&little), sizeof little);
    }
  return bytes;
}

void write_image(const std::string& path, const Image& image, const ImageStyle& style) {
  const auto format = style.format ? style.format : image_format(path);
  if (!format || !image_fits(*format, image.width, image.height, style.alpha.empty() ? 3 : 4))
    throw FileError(path, "cannot hold this picture");
  switch (*format) {
    case ImageFormat::png:
      return write_file(path, encode_png(image, style.tone, style.notes, style.alpha));
    case ImageFormat::hdr:
      return write_file(path, encode_hdr(image, style.notes));
    case ImageFormat::pfm:
      return write_file(path, encode_pfm(image));
    case ImageFormat::exr:
      return write_file(path, encode_exr(image, style.layers, style.notes, style.alpha));
  }
}

std::string encoding_text(const Encoding& encoding) {
  if (encoding.kind == Encoding::Kind::light)
    return "light";
  if (encoding.kind == Encoding::Kind::srgb)
    return "sRGB values";
  char text[64];
  std::snprintf(text, sizeof text, "values of gamma %g", encoding.exponent);
  return text;
}

Image read_image(const std::string& path, Encoding* encoding) {
  const std::string bytes = read_bytes(path);
  const auto format = image_format(path);
  if (!format)
    throw FileError(path, "not a picture this program reads (.png, .hdr, .pfm, .exr)");
  if (*format == ImageFormat::pfm)
    return read_pfm(path, bytes);
  if (*format == ImageFormat::exr)
    return read_exr(path, bytes);
  Image image = read_by_stb(path, bytes, *format);
  if (encoding && *format == ImageFormat::png)
    *encoding = png_encoding(bytes);
  return image;
}

}  // namespace grelha
