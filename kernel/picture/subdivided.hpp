#pragma once
// A picture by subdivision: interrupted, kept, gone on with, to the bits of one that was made in
// one go. Knows nothing of rays: whoever makes it says what a point sees.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "grelha/image.hpp"
#include "grelha/subdivision.hpp"

namespace grelha {

/// A point on the border of two tiles: its place on Morton's curve, and what it saw.
struct BorderPoint {
  std::uint64_t key;
  Float3 colour;
};

/// All that is known of a picture between two pieces of its work.
struct Subdivided {
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

/// Of a picture nothing is known of.
Subdivided make_subdivided(int width, int height);

/// Whether no number is one that subdivide() cannot leave behind: what a file says must pass this
/// before it is gone on with.
bool is_sound(const Subdivided& s);

/// Colours of points, all different and none asked for before. `from` and `to` say which share of
/// the picture is done before and after. Returns how many were seen, from the first on; fewer than
/// all to stop.
using SeePoints = std::function<std::size_t(
    std::span<const LatticePoint> points, Float3* colours, double from, double to)>;

/// Makes the picture whose pixels are their squares: the mean of four corners, or of four quarters
/// where a square is split. Whether it is finished: what was stopped another call goes on with,
/// unless `rest`, which may look at the picture, says to go on all the same. Works in tiles of
/// `tile` pixels a side (0: as large as 2^24 points allow were every square split), which changes
/// nothing but the order of points.
bool subdivide(Subdivided& picture,
               const Subdivision& options,
               const SeePoints& see,
               int tile = 0,
               const std::function<bool()>& rest = {});

}  // namespace grelha
