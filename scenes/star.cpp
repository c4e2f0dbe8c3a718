// A Siemens star: edges at every angle, ever closer towards the middle, and nothing else to sample.
#include <cmath>

#include "scenes/generators.hpp"
#include "scenes/nff_writer.hpp"

namespace grelha::scenes {

void write_star(std::ostream& out, const SceneOptions& options) {
  constexpr double kSpokeLength = 0.9, kEyeDistance = 4;
  constexpr double kTurn = 0.1;  // no edge lies along pixels
  NffWriter nff(out);
  nff.comment("A Siemens star that shines: its edges are all there is to see.");
  nff.background({0, 0, 0});
  // 2 atan(1/4)
  nff.view({.from = {0, 0, kEyeDistance}, .at = {0, 0, 0}, .up = {0, 1, 0}, .angle_deg = 28.0725});
  nff.glow({1, 1, 1});
  const auto rim = [&](int edge) {
    const double angle = kTurn + kPi * edge / options.size;
    return Vec{kSpokeLength * std::cos(angle), kSpokeLength * std::sin(angle), 0};
  };
  for (int spoke = 0; spoke < options.size; ++spoke)
    nff.polygon({{0, 0, 0}, rim(2 * spoke), rim(2 * spoke + 1)});
}

}  // namespace grelha::scenes
