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
  std::uint64_t large = 0;    ///< others, which stand in no grid of the scene and widen no window
  double across[2] = {0, 0};  ///< sums of widths and heights
  double area = 0;
  void add(const Window& w);
  void add(const Bounds& o);
  void add_large(const Bounds& o);
  /// Lays about so many square tiles, over a little more than the window.
  void lay_tiles(PointFace& face, double tiles) const;
  /// What the lists of a face's tiles hold at most, by bounds of what is seen.
  double most_references(const PointFace& face) const;
};

/// A tile of any level: its corner and width in tiles of its face. Width 0: beyond all others.
struct Tile {
  double x, y, width;
  int face;
};

/// Sets place k of a block.
void set_place(OutlineBlock& block, std::uint32_t k, const SeenOutline& seen, const Tile& tile);
void set_place(BoxBlock& block, std::uint32_t k, const SeenBox& seen, const Tile& tile);

}  // namespace grelha
