// Balls in a row that leads away from the camera: what depth of field is for.
#include "scenes/generators.hpp"
#include "scenes/nff_writer.hpp"

namespace grelha::scenes {

namespace {

constexpr double kRadius = 0.3, kSpacing = 1.5;

/// Ball i of `count`, the nearest first; the row is centred on the origin.
Vec center(int i, int count) {
  return {kSpacing * ((count - 1) / 2.0 - i), 0, 0};
}

/// Red, green, blue and round again, a little paler on each turn.
Vec color(int i) {
  const double pale = 1 - 1.0 / (1 + i / 3 * 0.5);
  Vec result{pale, pale, pale};
  (i % 3 == 0 ? result.x : i % 3 == 1 ? result.y : result.z) = 1;
  return result;
}

}  // namespace

void write_distant(std::ostream& out, const SceneOptions& options) {
  NffWriter nff(out);
  const int count = options.size;
  const Vec near = center(0, count), eye = near + Vec{2.2, -1.6, 0.8}, at = 0.5 * near;
  nff.comment("Balls that lead away from the camera; the lens is sharp at the nearest.");
  nff.background({0.05, 0.07, 0.12});
  nff.view({.from = eye, .at = at});
  nff.lens(20, length(near - eye) / length(at - eye));
  nff.light(near + Vec{2, -4, 5}, {1, 1, 1});
  nff.surface({.color = {1, 0.85, 0.6}, .kd = 0.8, .shine = 1, .ior = 1});
  nff.plane({1, 0, -kRadius}, {0, 1, -kRadius}, {-1, -1, -kRadius});
  for (int i = 0; i < count; ++i) {
    nff.surface({.color = color(i), .kd = 0.6, .ks = 0.3, .shine = 30.0827, .ior = 1});
    nff.sphere(center(i, count), kRadius);
  }
}

}  // namespace grelha::scenes
