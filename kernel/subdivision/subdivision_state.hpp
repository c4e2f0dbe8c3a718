#pragma once
// A picture by subdivision between two pieces of its work: plain data, to be copied and kept.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "grelha/geometry.hpp"
#include "grelha/image.hpp"

namespace grelha {

/// A point on the border of two tiles: its place on Morton's curve, and what it saw.
struct BorderPoint {
  std::uint64_t key;
  Float3 colour;
};

/// A picture by subdivision: the tiles that are finished, and of the tile in work the colours.
struct SubdivisionState {
  Image image;            ///< of the tile in work what there is; tiles not begun are black
  std::size_t tiles = 0;  ///< finished: they come row by row
  /// [columns of tiles] by key: the lower borders of those finished last
  std::vector<std::vector<BorderPoint>> above;
  /// by key: the right border of the one finished last
  std::vector<BorderPoint> left;
  /// of the tile in work, numbered as it asks for them; on borders with finished tiles first
  std::vector<Float3> colours;
  double share = 0;  ///< done, as far as is known
};

/// A picture without points. Throws std::invalid_argument for a size that has no lattice.
SubdivisionState make_subdivision(int width, int height);

/// Whether every number is one that subdivide() can leave behind: what a file says must pass this
/// before it is gone on with.
bool is_sound(const SubdivisionState& s);

}  // namespace grelha
