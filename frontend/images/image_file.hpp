#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "frontend/images/image_style.hpp"
#include "grelha/image.hpp"

namespace grelha {

using FormatName = std::pair<std::string_view, ImageFormat>;
/// The formats by their endings.
inline constexpr std::array kImageFormats{FormatName{"png", ImageFormat::png},
                                          FormatName{"hdr", ImageFormat::hdr},
                                          FormatName{"pfm", ImageFormat::pfm},
                                          FormatName{"exr", ImageFormat::exr}};

/// The format by the name's ending, .png, .hdr, .pfm or .exr in any case; empty for others.
std::optional<ImageFormat> image_format(std::string_view path);

/// The ending of such files: "png".
std::string_view ending_of(ImageFormat format);

/// Returns whether the format's writer can hold a picture of that size, with 3 channels or 4.
bool image_fits(ImageFormat format, int width, int height, int channels = 3);

/// Reads the encoding of a PNG from its chunks sRGB and gAMA: https://www.w3.org/TR/png-3/
Encoding png_encoding(std::string_view png);

/// The file's bytes: hdr_file.hpp has the others. .pfm (little endian, bottom row first) holds
/// linear floats, exactly, and has no place for notes.
std::string encode_png(const Image& image,
                       Tone tone,
                       const Notes& notes = {},
                       const Alpha& alpha = {});
/// A PNG of these bytes, rows of 3 or 4 channels.
std::string encode_png(std::span<const std::uint8_t> pixels,
                       int width,
                       int height,
                       Tone tone,
                       const Notes& notes = {});
std::string encode_pfm(const Image& image);

/// Writes the file whole or not at all, or to stdout. Throws FileError.
void write_image(const std::string& path, const Image& image, const ImageStyle& style = {});

/// "light", "sRGB values", "values of gamma 0.45455"
std::string encoding_text(const Encoding& encoding);

/// Reads what write_image writes and other files of these kinds, but none that shine through. A
/// PNG's bytes come as byte / 255, unbent; `encoding`, where given, says how they were bent.
Image read_image(const std::string& path, Encoding* encoding = nullptr);

}  // namespace grelha
