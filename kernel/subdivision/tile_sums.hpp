#pragma once
// The pixels of one tile of a subdivided picture, as sums of their squares.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "grelha/geometry.hpp"
#include "grelha/image.hpp"
#include "kernel/subdivision/tile_points.hpp"

namespace grelha {

/// Sums by pixel of a tile.
class TileSums {
 public:
  /// Black.
  explicit TileSums(const TileRect& rect);

  /// Adds a square, by its corners. `level`: how often its pixel was split to get it.
  void add(std::uint32_t pixel, const Float3 (&corners)[4], int level);

  /// Writes the pixels into the picture.
  void show(Image& image) const;

  std::size_t size() const { return sums_.size(); }
  std::size_t width() const { return static_cast<std::size_t>(rect_.x1 - rect_.x0); }

 private:
  struct Sum {
    double r = 0;
    double g = 0;
    double b = 0;
  };
  TileRect rect_;
  std::vector<Sum> sums_;
};

}  // namespace grelha
