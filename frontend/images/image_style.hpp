#pragma once
// What writers and readers of pictures share: how a picture is written, and what a file says of it.

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

/// What a file says of its picture: key and text, both printable ASCII without line ends.
using Note = std::pair<std::string, std::string>;
using Notes = std::vector<Note>;

/// What camera rays through the centres of pixels meet first, beside the picture in an OpenEXR
/// file. Empty: not there.
struct Layers {
  /// [pixels] from the eye, scene units; infinite where nothing is met
  std::vector<float> depth{};
  /// [pixels * 3] unit, as shaded, towards the eye; 0 where nothing is met
  std::vector<float> normal{};
  /// [pixels] of the primitive, see primitive_of(); kNoPrimitive where nothing is met
  std::vector<std::uint32_t> id{};
};

/// How a picture is written.
struct ImageStyle {
  std::optional<ImageFormat> format{};  ///< absent: by the name's ending
  Tone tone = Tone::authored;
  Notes notes{};
  Layers layers{};
};

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

}  // namespace grelha
