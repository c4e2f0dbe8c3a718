#pragma once
// Radiance's format: three mantissas of eight bits that share an exponent. Ward, "Real Pixels",
// Graphics Gems II (1991).

#include <string>

#include "frontend/images/image_style.hpp"
#include "grelha/image.hpp"

namespace grelha {

/// The file's bytes; notes are comments of its head. Values are light: a negative value or a NaN
/// becomes 0.
std::string encode_hdr(const Image& image, const Notes& notes = {});

}  // namespace grelha
