#pragma once

#include <cstdint>
#include <vector>

#include "kernel/scene/pages.hpp"
#include "kernel/scene/shading_view.hpp"

namespace grelha {

/// Pixels in the order their samples are taken: tile by tile of 8 x 8, along a Z in each, so that
/// neighbours share packets.
inline std::vector<std::uint32_t> pixel_order(int width, int height) {
  std::vector<std::uint32_t> order;
  reserve_to_fill(order, static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int ty = 0; ty < height; ty += kTile)
    for (int tx = 0; tx < width; tx += kTile)
      for (int i = 0; i < kTile * kTile; ++i) {
        const int x = tx + tile_x(i);
        const int y = ty + tile_y(i);
        if (x < width && y < height)
          order.push_back(static_cast<std::uint32_t>(y * static_cast<std::int64_t>(width) + x));
      }
  return order;
}

}  // namespace grelha
