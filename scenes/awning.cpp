// Plates that throw small soft shadows: how much of the light a floor point sees matters as much as
// where in the pixel it lies.
#include <cstdint>

#include "scenes/generators.hpp"
#include "scenes/nff_writer.hpp"

namespace grelha::scenes {

void write_awning(std::ostream& out, const SceneOptions& options) {
  // heights: a shadow is twice its plate, a penumbra the lamp's own side
  constexpr double kEye = 8, kPlates = 9, kLamp = 18;
  constexpr double kPitch = 0.1, kSide = 0.05, kLampSide = 0.05;
  NffWriter nff(out);
  nff.comment(
      "A floor under plates, seen from below them; every shadow has an edge about as wide as a "
      "pixel of 192.");
  nff.background({0, 0, 0});
  // 2 atan(1/2)
  nff.view({.from = {0, 0, kEye},
            .at = {0, 0, 0},
            .up = {0, 1, 0},
            .angle_deg = 53.1301,
            .width = 192,
            .height = 192});
  nff.area_light(
      {-kLampSide / 2, -kLampSide / 2, kLamp}, {kLampSide, 0, 0}, {0, kLampSide, 0}, {1, 1, 1});
  nff.surface({.color = {1, 1, 1}, .kd = 1, .ior = 1});
  nff.plane({-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
  const int n = options.size;
  for (int row = 0; row < n; ++row)
    // off the lattice by whole hundredths, so that shadows meet pixels at every place
    for (int column = 0; column < n; ++column) {
      const double x = (column - n / 2) * kPitch + (column * 7 + row * 3) % 5 / 100.0;
      const double y = (row - n / 2) * kPitch + (column * 5 + row * 11) % 6 / 100.0;
      nff.polygon({{x, y, kPlates},
                   {x + kSide, y, kPlates},
                   {x + kSide, y + kSide, kPlates},
                   {x, y + kSide, kPlates}});
    }
}

}  // namespace grelha::scenes
