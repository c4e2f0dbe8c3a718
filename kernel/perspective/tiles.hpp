#pragma once
// How a face is laid with tiles, and what stands in their lists.

#include <cstdint>

#include "kernel/perspective/seen.hpp"

namespace grelha {

/// The part of a face that primitives are seen in, and how many.
struct Window {
  double lo[2] = {1e300, 1e300}, hi[2] = {-1e300, -1e300};
  double near = 1e300;
  std::uint64_t seen = 0;
  void add(const Window& w);
  void add(const Outline& o);
  /// Lays about so many square tiles, over a little more than the window.
  void lay_tiles(PointFace& face, double tiles) const;
};

/// A tile of any level: its corner and width in tiles of its face. Width 0: beyond all others.
struct Tile {
  double x, y, width;
  int face;
};

/// As lists hold it, not above.
float least_depth(const Seen& seen);

/// Sets place k of a block.
void set_outline(OutlineBlock& block, std::uint32_t k, const Seen& seen, const Tile& tile);
void set_box(BoxBlock& block, std::uint32_t k, const Seen& seen, const Tile& tile);

}  // namespace grelha
