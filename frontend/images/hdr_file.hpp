#pragma once
// Formats of high dynamic range: OpenEXR, by the library of that name (https://openexr.com), and
// Radiance's, whose three mantissas of eight bits share an exponent. Ward, "Real Pixels", Graphics
// Gems II (1991).

#include <cstdint>
#include <string>
#include <vector>

#include "frontend/images/image_style.hpp"
#include "grelha/image.hpp"

namespace grelha {

/// Scanlines of floats, packed in blocks without loss. Notes become attributes of type string,
/// their keys in small letters; alpha becomes the channel A.
std::string encode_exr(const Image& image,
                       const Layers& layers = {},
                       const Notes& notes = {},
                       const Alpha& alpha = {});

/// The channels R, G and B, or Y alone, of the first part that has them, whatever its types, tiles
/// and compression. Pixels outside the data window are black. Throws FileError, also for a picture
/// that shines through.
Image read_exr(const std::string& path, const std::string& bytes);

/// The file's bytes; notes are comments of its head. Values are light: a negative value or a NaN
/// becomes 0.
std::string encode_hdr(const Image& image, const Notes& notes = {});

}  // namespace grelha
