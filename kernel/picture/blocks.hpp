#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernel/base/pages.hpp"
#include "kernel/scene/shading_view.hpp"

namespace grelha {

/// Side of a block of pixels whose samples are taken together: a packet is full even if each pixel
/// takes few samples.
inline constexpr int kBlockSide = 4;
inline constexpr int kBlockPixels = kBlockSide * kBlockSide;

/// A picture in blocks, row by row; those at its right and lower edges may have fewer pixels.
struct Blocks {
  int width, height;  ///< pixels
  int columns, rows;

  Blocks(int of_width, int of_height)
      : width(of_width),
        height(of_height),
        columns((of_width + kBlockSide - 1) / kBlockSide),
        rows((of_height + kBlockSide - 1) / kBlockSide) {}

  std::size_t count() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
  std::size_t of(int x, int y) const {
    return static_cast<std::size_t>(y / kBlockSide) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(x / kBlockSide);
  }
  std::size_t of_pixel(std::size_t p) const {
    const auto w = static_cast<std::size_t>(width);
    return of(static_cast<int>(p % w), static_cast<int>(p / w));
  }

  /// Calls visit(pixel) for those of a block, along a Z.
  template <class Visit>
  void each_pixel(std::size_t block, const Visit& visit) const {
    const auto c = static_cast<std::size_t>(columns);
    const int x0 = static_cast<int>(block % c) * kBlockSide;
    const int y0 = static_cast<int>(block / c) * kBlockSide;
    for (int k = 0; k < kBlockPixels; ++k) {
      const int x = x0 + tile_x(k), y = y0 + tile_y(k);
      if (x < width && y < height)
        visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
              static_cast<std::size_t>(x));
    }
  }
  std::size_t pixels(std::size_t block) const {
    const auto c = static_cast<std::size_t>(columns);
    const int x0 = static_cast<int>(block % c) * kBlockSide;
    const int y0 = static_cast<int>(block / c) * kBlockSide;
    return static_cast<std::size_t>(std::min(kBlockSide, width - x0)) *
           static_cast<std::size_t>(std::min(kBlockSide, height - y0));
  }

  /// All blocks, tile by tile: those that follow each other share packets and cells of grids.
  std::vector<std::uint32_t> by_tiles() const {
    constexpr int kOfTile = kTile / kBlockSide;
    std::vector<std::uint32_t> order;
    reserve_to_fill(order, count());
    for (int ty = 0; ty < rows; ty += kOfTile)
      for (int tx = 0; tx < columns; tx += kOfTile)
        for (int k = 0; k < kOfTile * kOfTile; ++k) {
          const int x = tx + k % kOfTile, y = ty + k / kOfTile;
          if (x < columns && y < rows)
            order.push_back(static_cast<std::uint32_t>(of(x * kBlockSide, y * kBlockSide)));
        }
    return order;
  }
};

}  // namespace grelha
