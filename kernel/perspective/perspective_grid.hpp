#pragma once
// A grid in a point's perspective: the directions around it in tiles, each with the primitives that
// rays through it may meet, nearest first. After Hunt, Mark, "Ray-Specialized Acceleration
// Structures for Ray Tracing", RT 2008, and Haines, Greenberg, "The Light Buffer", 1986.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kernel/perspective/look_loops.hpp"
#include "kernel/perspective/view.hpp"
#include "kernel/scene/raw_vector.hpp"

namespace grelha {

struct PerspectiveGrid {
  double point[3] = {};
  PointFace face[kFaces];
  std::vector<TileLists> tiles;  ///< and one behind the last
  RawVector<OutlineBlock> outlines;
  RawVector<BoxBlock> boxes;
  std::vector<std::uint32_t> around;

  PointGridView view() const;
  std::size_t bytes() const;
  std::size_t references() const;
};

struct PerspectiveOptions {
  const LookLoops& loops;
  double density = .125;  ///< tiles a primitive
  int threads = 1;
};

/// Of the finite primitives `ids` of a scene, as seen from a point. Those of `large`, which is
/// sorted, are left out where tiles are laid: they may be met in any direction. None: primitives
/// cover each other so much that rays are better off in the scene's grids.
std::optional<PerspectiveGrid> build_perspective_grid(const Primitives& primitives,
                                                      std::span<const std::uint32_t> ids,
                                                      std::span<const std::uint32_t> large,
                                                      const Viewpoint& from,
                                                      const PerspectiveOptions& options);

}  // namespace grelha
