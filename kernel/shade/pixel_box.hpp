#pragma once
// A part of a pixel that is sampled more often than the rest, since something small was found
// there. Kept in a word: 8 bits for each side, in 256ths of the pixel; 0: there is none.

#include <algorithm>
#include <cstdint>

#include "kernel/scene/shading_view.hpp"

namespace grelha {

/// A part no larger than this pays: of larger ones ordinary samples tell soon enough (a choice).
inline constexpr float kLargestBox = .25f;

/// Sides of a box, 0 to 1 from the upper left corner of the pixel on.
struct PixelBox {
  float x0, y0, x1, y1;
  float area() const { return (x1 - x0) * (y1 - y0); }
};

/// The least that holds it; 0 where there is none.
inline std::uint32_t packed(const PixelBox& box) {
  const auto first = [](float x) {
    return static_cast<std::uint32_t>(std::clamp(256 * x, 0.f, 255.f));
  };
  if (!(box.x0 <= box.x1 && box.y0 <= box.y1))
    return 0;
  const std::uint32_t word =
      first(box.x0) | first(box.y0) << 8 | first(box.x1) << 16 | first(box.y1) << 24;
  return word != 0 ? word : 0x01010000u;  // which is none's
}
inline PixelBox unpacked(std::uint32_t word) {
  const auto side = [](std::uint32_t bits) { return static_cast<float>(bits & 255) / 256; };
  constexpr float kStep = 1.f / 256;
  return {side(word), side(word >> 8), side(word >> 16) + kStep, side(word >> 24) + kStep};
}

}  // namespace grelha
