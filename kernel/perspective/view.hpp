#pragma once
// A built point grid as plain pointers.

#include <cstdint>

namespace grelha {

/// Primitives side by side in a block.
inline constexpr int kOutlines = 8;

/// See OutlineBlock.
inline constexpr float kSurelyInside = 2;

/// How directions around a point are told apart: six faces of a cube, 2 axis + (negative ? 1 : 0).
inline constexpr int kFaces = 6;

/// The tiles of one face. A direction (p, q, r) along the face's next axis, the one after and its
/// own has place x = (p / |r| - u) per_u, y = (q / |r| - v) per_v in tiles. Beyond all of them is
/// one tile more, nx ny behind the first.
struct PointFace {
  double u = 0;
  double v = 0;
  double per_u = 0;
  double per_v = 0;
  double depth = 0;       ///< depths in lists count from this one
  double nx = 0, ny = 0;  ///< whole numbers; 0: all is beyond
  double first = 0;       ///< number of its first tile; x runs fastest
};

/// What eight primitives look like from the point, within a tile: none of them can be met by a ray
/// through place (x, y) of the tile, 0 to 1 each, where one of its three sides, side[i][0] x +
/// side[i][1] y + side[i][2], is negative. What is left open is 1 on either side of it: a triangle
/// is surely met where all are kSurelyInside or more, by rays that start behind its `far`.
struct alignas(64) OutlineBlock {
  float side[3][3][kOutlines];
  float near[kOutlines];  ///< least depth
  float far[kOutlines];   ///< greatest; infinite where no ray meets it for sure
  std::uint32_t id[kOutlines];
};

/// The same of eight spheres: boxes around what they look like, in the tile's x and y.
struct alignas(64) BoxBlock {
  float lo[2][kOutlines], hi[2][kOutlines];
  float near[kOutlines];
  std::uint32_t id[kOutlines];
};

/// The two kinds of lists that a tile has.
inline constexpr int kOutlineList = 0;
inline constexpr int kBoxList = 1;

/// A tile, all that a look-up needs to know of it in one place.
struct TileLists {
  /// where its lists begin, by kind, in places of blocks of eight; they end where the next tile's
  /// begin
  std::uint32_t first[2] = {};
  /// where it is looked up again since it is crowded: tiles, columns x columns of them; 0: nowhere
  std::uint32_t part = 0, columns = 0;
  bool operator==(const TileLists&) const = default;
};

/// Lists hold what is nearest to the point first.
struct PointGridView {
  double point[3] = {};
  PointFace face[kFaces];
  const TileLists* tiles = nullptr;  ///< and one behind the last
  const OutlineBlock* outlines = nullptr;
  const BoxBlock* boxes = nullptr;
  /// too near the point to have an outline: for every ray
  const std::uint32_t* around = nullptr;
  std::uint32_t around_count = 0;
};

}  // namespace grelha
