#pragma once
// What a tile's beams doubt of a scene, seen by one camera.

#include <array>

#include "kernel/world/world_impl.hpp"
#include "kernel/query/variants.hpp"
#include "kernel/scene/frame.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {

/// Of each pixel twice the weight of what hides inside, or that of what its corners differ in.
using Tile = std::array<float, kTile * kTile>;

/// Looks along -z from z = 200 at 8 x 8 pixels, each one unit across at z = 0: pixel (x, y) there
/// covers [x - 4, x - 3] x [3 - y, 4 - y].
inline Camera over_units() {
  Camera c;
  c.eye = {0, 0, 200};
  c.at = {0, 0, 0};
  c.up = {0, 1, 0};
  c.width = c.height = 8;
  c.angle_deg = 2 * 1.1457628381751033;  // atan(4 / 200)
  return c;
}

/// Everything, of every pixel.
inline PixelsAsked all_asked() {
  constexpr std::uint64_t kAll = ~std::uint64_t{0};
  PixelsAsked asked{.things = kAll, .shadows = kAll};
  std::fill(asked.lights, asked.lights + kTile * kTile, kAll);
  return asked;
}

inline PixelDoubts doubts(const Scene& scene,
                          const Variant& variant,
                          const BuildOptions& build = {},
                          const Camera& camera = over_units(),
                          const PixelsAsked& asked = all_asked()) {
  const World world(scene, build);
  const World::Impl& w = world.impl();
  PixelDoubts found;
  TraceCounts counts;
  variant.loops.doubt(w.view, w.shading, make_frame(camera), 0, 0, 2, 0, asked, found, counts);
  return found;
}

inline Tile doubt(const Scene& scene,
                  const Variant& variant,
                  const BuildOptions& build = {},
                  const Camera& camera = over_units()) {
  const PixelDoubts found = doubts(scene, variant, build, camera);
  Tile out;
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = std::max(2 * std::max(found.inside[i], found.boxed[i]), found.around[i]);
  return out;
}

inline float at(const Tile& tile, int x, int y) {
  return tile[static_cast<std::size_t>(8 * y + x)];
}

/// A wall at z = 0 that fills the picture, lit from the eye's side.
inline Scene wall() {
  Scene s = one_plane({0, 0, 0}, {0, 0, 1});
  s.lights = {{{30, 0, 40}, {1, 1, 1}}};
  return s;
}

}  // namespace grelha::test
