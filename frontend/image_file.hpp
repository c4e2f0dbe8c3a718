#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "kernel/image.hpp"

namespace grelha {

enum class ImageFormat { png, hdr, pfm };

/// By the name's ending, upper or lower case; empty when it is none of .png, .hdr, .pfm.
std::optional<ImageFormat> image_format(std::string_view path);

/// The ending of such files: "png".
std::string_view ending_of(ImageFormat format);

/// How a PNG shows a colour: as it was authored, or as light of that strength through the sRGB curve.
enum class Tone { authored, srgb };

/// 0..1 to 0..255, to nearest; what lies outside is clamped and NaN is black.
std::uint8_t to_byte(float value, Tone tone);

/// Whether the format's writer can hold a picture of that size.
bool image_fits(ImageFormat format, int width, int height);

/// The file's bytes. .hdr (Radiance RGBE) and .pfm (little endian, bottom row first) hold linear floats; only .pfm is
/// exact.
std::string encode_png(const Image& image, Tone tone);
std::string encode_hdr(const Image& image);
std::string encode_pfm(const Image& image);

/// How a picture is written.
struct ImageStyle {
  std::optional<ImageFormat> format{};  ///< absent: by the name's ending
  Tone tone = Tone::authored;
};

/// Writes the file whole or not at all, or to stdout. Throws FileError.
void write_image(const std::string& path, const Image& image, const ImageStyle& style = {});

/// Reads what write_image writes and other files of these kinds. A PNG's bytes come as byte / 255, unbent.
Image read_image(const std::string& path);

}  // namespace grelha
