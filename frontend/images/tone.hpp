#pragma once
// Converts light to the numbers of a picture, and back.

#include <cstdint>
#include <vector>

#include "frontend/images/image_style.hpp"
#include "grelha/image.hpp"

namespace grelha {

/// The light of an sRGB value, both from 0 to 1. IEC 61966-2-1.
double light_of_srgb(double encoded);

/// Rounds 0..1 to 0..255; other values are clamped, and NaN is black.
std::uint8_t to_byte(float value, Tone tone);

/// The same for a whole picture.
std::vector<std::uint8_t> to_bytes(const Image& image, Tone tone);

/// Four channels a pixel; the colours are divided by alpha (unassociated).
std::vector<std::uint8_t> to_bytes(const Image& image, Tone tone, const Alpha& alpha);

/// Decodes an image to light.
Image as_light(Image image, const Encoding& encoding);

}  // namespace grelha
