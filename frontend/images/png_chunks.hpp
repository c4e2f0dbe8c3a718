#pragma once
// What a PNG says beside its pixels: https://www.w3.org/TR/png-3/

#include <string>
#include <string_view>

#include "frontend/images/image_style.hpp"

namespace grelha {

/// `png` with an sRGB chunk, when that is its tone, and one tEXt chunk a note, before the pixels.
std::string with_chunks(const std::string& png, Tone tone, const Notes& notes);

/// What its chunks sRGB and gAMA say.
Encoding png_encoding(std::string_view png);

}  // namespace grelha
