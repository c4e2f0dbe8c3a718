#pragma once
// Types that the readers and writers of pictures share: the style of a picture, and its notes.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace grelha {

enum class ImageFormat { png, hdr, pfm, exr };

/// How a PNG shows a colour: as it was authored, or as light of that strength through the sRGB
/// curve.
enum class Tone { authored, srgb };

/// A note in a picture's file: key and text, both printable ASCII without line ends.
using Note = std::pair<std::string, std::string>;
using Notes = std::vector<Note>;

/// The first hits of camera rays through the pixel centres, stored beside the picture in an OpenEXR
/// file. An empty vector is absent.
struct Layers {
  /// [pixels] from the eye, scene units; infinite where nothing is hit
  std::vector<float> depth{};
  /// [pixels * 3] unit, as shaded, towards the eye; 0 where nothing is hit
  std::vector<float> normal{};
  /// [pixels] of the primitive, see primitive_of(); kNoPrimitive where nothing is hit
  std::vector<std::uint32_t> id{};
};

/// [pixels] the share of samples that hit something; the picture's colours are times that
/// (associated). Empty: 1 everywhere.
using Alpha = std::vector<float>;

/// Why a picture is not read.
inline constexpr char kTransparent[] = "expected an opaque picture, found alpha below 1";

/// The options for writing a picture.
struct ImageStyle {
  std::optional<ImageFormat> format{};  ///< absent: by the name's ending
  Tone tone = Tone::authored;
  Notes notes{};
  Layers layers{};
  Alpha alpha{};  ///< for PNG and OpenEXR
};

/// The encoding of the numbers in a file.
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

}  // namespace grelha
