#pragma once
// Pixels in which something thinner than two of them may show, or its shadow: where samples that
// agree may all have missed it. What is wider covers whole pixels, whose samples tell of it.

#include "grelha/stats.hpp"
#include "kernel/marks/pixel_marks.hpp"
#include "kernel/render/setup.hpp"
#include "kernel/world/world_impl.hpp"

namespace grelha {

/// Where they are. Triangles inside of a mesh are no things of their own, see MeshRims, nor is a
/// mesh where it looks wider, see RimWalk, or turns away and is thicker, see MeshThickness. Shadows
/// are those of the middles of lights, on what lies right behind.
struct SmallThings {
  SmallThings(const World::Impl& world, const Setup& setup, int threads, TraceCounts& counts);

  /// Bits of the lights whose thin shadows may show in a pixel, see kLightBits.
  std::uint64_t lights(int x, int y) const;

  PixelMarks thin;                  ///< where things show that are thinner than two pixels
  std::vector<PixelMarks> shadows;  ///< [bits of lights] where such shadows do
  PixelMarks small;                 ///< where either does that is no longer than that
  /// Something thin is no part of a larger mesh: mirrors and clear surfaces may show it anywhere.
  bool stand_alone = false;
  /// The same of what looks so thin by way of a mirror: else none shows anything thin.
  bool mirrored = false;
};

}  // namespace grelha
