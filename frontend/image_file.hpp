#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kernel/image.hpp"

namespace grelha {

enum class ImageFormat { png, hdr, pfm, exr };

/// By the name's ending, upper or lower case; empty when it is none of .png, .hdr, .pfm, .exr.
std::optional<ImageFormat> image_format(std::string_view path);

/// The ending of such files: "png".
std::string_view ending_of(ImageFormat format);

/// How a PNG shows a colour: as it was authored, or as light of that strength through the sRGB curve.
enum class Tone { authored, srgb };

/// 0..1 to 0..255, to nearest; what lies outside is clamped and NaN is black.
std::uint8_t to_byte(float value, Tone tone);

/// Whether the format's writer can hold a picture of that size.
bool image_fits(ImageFormat format, int width, int height);

/// What a file says of its picture: key and text, both printable ASCII without line ends.
using Note = std::pair<std::string, std::string>;
using Notes = std::vector<Note>;

/// The file's bytes. .hdr (Radiance RGBE) and .pfm (little endian, bottom row first) hold linear floats; .pfm is
/// exact, and has no place for notes. OpenEXR: exr_file.hpp.
std::string encode_png(const Image& image, Tone tone, const Notes& notes = {});
std::string encode_hdr(const Image& image, const Notes& notes = {});
std::string encode_pfm(const Image& image);

/// What camera rays through the centres of pixels meet first, beside the picture in an OpenEXR file. Empty: not there.
struct Layers {
  std::vector<float> depth{};       ///< [pixels] from the eye, scene units; infinite where nothing is met
  std::vector<float> normal{};      ///< [pixels * 3] unit, as shaded, towards the eye; 0 where nothing is met
  std::vector<std::uint32_t> id{};  ///< [pixels] of the primitive, see primitive_of(); kNoPrimitive where nothing is met
};

/// How a picture is written.
struct ImageStyle {
  std::optional<ImageFormat> format{};  ///< absent: by the name's ending
  Tone tone = Tone::authored;
  Notes notes{};
  Layers layers{};
};

/// Writes the file whole or not at all, or to stdout. Throws FileError.
void write_image(const std::string& path, const Image& image, const ImageStyle& style = {});

/// What the numbers of a file stand for.
struct Encoding {
  enum class Kind {
    light,  ///< as they are; also where a PNG does not say: then they are the colours as authored
    srgb,   ///< after as_light() by the sRGB curve
    power,  ///< of light to the power `exponent`: a PNG's gAMA
  };
  Kind kind = Kind::light;
  double exponent = 1;
  bool operator==(const Encoding&) const = default;
};

/// "light", "sRGB values", "values of gamma 0.45455"
std::string encoding_text(const Encoding& encoding);

/// Reads what write_image writes and other files of these kinds. A PNG's bytes come as byte / 255, unbent; `encoding`,
/// where given, says how they were bent.
Image read_image(const std::string& path, Encoding* encoding = nullptr);

/// Of numbers so encoded, the light they stand for.
Image as_light(Image image, const Encoding& encoding);

}  // namespace grelha
