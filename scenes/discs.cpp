// A field of discs far smaller than a pixel: what samples at a few fixed places miss, and never
// know that they missed.
#include <cstdint>

#include "scenes/generators.hpp"
#include "scenes/nff_writer.hpp"

namespace grelha::scenes {

namespace {

// sides of the picture; a scene unit is a pixel of it, the origin its middle
constexpr int kPixels = 512;
constexpr double kDiscRadius = 0.1;  // so a disc covers pi / 100 of its pixel
// nearly parallel rays: discs stay round to .4 %, 1/cos at the corners
constexpr double kDistance = 16 * kPixels / 2;
constexpr double kAngleDeg = 7.15267;  // 2 atan(1/16)

/// Whole numbers alone, so that a disc lies at the same place everywhere.
std::uint32_t scatter(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7FEB352Du;
  x ^= x >> 15;
  x *= 0x846CA68Bu;
  return x ^ x >> 16;
}

/// Along one axis: some pixel of cell `cell` of `count`, and hundredths of it that keep a disc off
/// the pixel's edges.
double place(int cell, int count, std::uint32_t bits) {
  constexpr int kMargin = 15, kSteps = 100 - 2 * kMargin + 1;
  const int first = kPixels * cell / count, wide = kPixels * (cell + 1) / count - first;
  const int pixel = first + int(bits % std::uint32_t(wide)),
            hundredths = kMargin + int((bits >> 16) % kSteps);
  return pixel - kPixels / 2 + hundredths / 100.0;
}

}  // namespace

void write_discs(std::ostream& out, const SceneOptions& options) {
  NffWriter nff(out);
  nff.comment(
      "Discs that shine, a tenth of a pixel in radius at 512x512, one to a cell and each within "
      "one pixel.");
  nff.background({0, 0, 0});
  nff.view({.from = {0, 0, kDistance},
            .at = {0, 0, 0},
            .up = {0, 1, 0},
            .angle_deg = kAngleDeg,
            .width = kPixels,
            .height = kPixels});
  nff.glow({1, 1, 1});
  const int n = options.size;
  for (int row = 0; row < n; ++row) {
    for (int column = 0; column < n; ++column) {
      const std::uint32_t bits = scatter(std::uint32_t(row * n + column));
      nff.sphere({place(column, n, bits), place(row, n, scatter(bits)), 0}, kDiscRadius);
    }
  }
}

}  // namespace grelha::scenes
