#pragma once
// The chunks of a PNG beside its pixels: https://www.w3.org/TR/png-3/

#include <string>
#include <string_view>

#include "frontend/images/image_style.hpp"

namespace grelha {

/// `png` with an sRGB chunk, when that is its tone, and one tEXt chunk a note, before the pixels.
std::string with_chunks(const std::string& png, Tone tone, const Notes& notes);

/// Reads the encoding from the chunks sRGB and gAMA.
Encoding png_encoding(std::string_view png);

}  // namespace grelha
