#pragma once
// The lattice points of one tile of a subdivided picture, by number.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "grelha/subdivision.hpp"
#include "kernel/subdivision/subdivision_state.hpp"

namespace grelha {

/// Place on Morton's curve: points sorted by it are neighbours, for the packets' sake.
std::uint64_t morton(LatticePoint p);

/// Pixels x0 <= x < x1, y0 <= y < y1.
struct TileRect {
  int x0 = 0;
  int y0 = 0;
  int x1 = 0;
  int y1 = 0;
};

/// Numbers points in the order in which a tile asks for them. Points that finished tiles saw on
/// their borders with this one have the first numbers.
class TilePoints {
 public:
  /// Begins a tile. `above` and `left`: what the tiles there saw on their borders with it.
  /// `colours` become those of the points known, unless they belong to this tile already.
  void load_border(const TileRect& rect,
                   const std::vector<BorderPoint>& above,
                   const std::vector<BorderPoint>& left,
                   std::vector<Float3>& colours);

  /// The number of a point not asked for in this tile before. `key`: its morton().
  std::uint32_t number(LatticePoint p, std::uint64_t key);

  /// Points that have numbers and no colours yet, by number, from first_fresh() on.
  const std::vector<LatticePoint>& fresh() const { return fresh_; }
  std::size_t first_fresh() const { return numbered_; }
  /// The fresh points have colours now.
  void accept_fresh();

  /// Keeps what the tiles below and to the right will ask for.
  void store_border(const std::vector<Float3>& colours,
                    std::vector<BorderPoint>& lower,
                    std::vector<BorderPoint>& right);

 private:
  /// A point on a border of the tile, and where in its colours that stands.
  struct Border {
    std::uint64_t key;
    std::uint32_t id;
  };
  /// The point, if a finished tile saw it, or null.
  const BorderPoint* known_at(LatticePoint p, std::uint64_t key) const;
  static void store(std::vector<Border>& border,
                    const std::vector<Float3>& colours,
                    std::vector<BorderPoint>& to);

  TileRect rect_;
  std::vector<BorderPoint> known_;
  std::size_t numbered_ = 0;  ///< points before the fresh ones
  std::vector<LatticePoint> fresh_;
  std::vector<Border> right_border_, lower_border_;
};

}  // namespace grelha
