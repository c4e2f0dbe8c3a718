#pragma once
// A bit for each pixel of a picture, set by any number of threads.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <vector>

#include "kernel/scene/shading_view.hpp"

namespace grelha {

class PixelMarks {
 public:
  PixelMarks(int width, int height)
      : width_(width),
        height_(height),
        columns_((width + kTile - 1) / kTile),
        tiles_(static_cast<std::size_t>(columns_) *
               static_cast<std::size_t>((height + kTile - 1) / kTile)) {}

  int width() const { return width_; }
  int height() const { return height_; }
  /// In which anything that crosses the picture is marked.
  double most_steps() const { return 4. * (width_ + height_); }

  /// Sets pixels that reach into a box of the picture, in pixels from its upper left corner.
  void mark(double x0, double y0, double x1, double y1) {
    each_tile(x0, y0, x1, y1, [&](std::size_t tile, std::uint64_t bits) {
      set(tiles_[tile], bits);
      return true;
    });
  }
  /// Whether all of these are set.
  bool has_all(double x0, double y0, double x1, double y1) const {
    return each_tile(x0, y0, x1, y1, [&](std::size_t tile, std::uint64_t bits) {
      return (~tiles_[tile].load(std::memory_order_relaxed) & bits) == 0;
    });
  }
  void mark_all() {
    for (std::atomic<std::uint64_t>& tile : tiles_)
      tile = ~std::uint64_t{0};
  }

  /// Of the tile whose upper left pixel is (x0, y0), bits [8 y + x].
  std::uint64_t tile(int x0, int y0) const { return tiles_[tile_at(x0, y0)]; }
  bool has(int x, int y) const { return tile(x, y) >> bit_at(x, y) & 1; }

 private:
  /// Calls go_on(tile, bits) for the pixels of a box, as long as it says so; returns whether it
  /// always did.
  template <class GoOn>
  bool each_tile(double x0, double y0, double x1, double y1, const GoOn& go_on) const {
    if (!(x1 >= 0 && y1 >= 0 && x0 < width_ && y0 < height_ && x0 <= x1 && y0 <= y1))
      return true;
    const int left = static_cast<int>(std::max(x0, 0.));
    const int right = static_cast<int>(std::min(x1, width_ - 1.));
    const int upper = static_cast<int>(std::max(y0, 0.));
    const int lower = static_cast<int>(std::min(y1, height_ - 1.));
    for (int y = upper - upper % kTile; y <= lower; y += kTile)
      for (int x = left - left % kTile; x <= right; x += kTile)
        if (!go_on(tile_at(x, y), kColumn * bits(left - x, right - x) & rows(upper - y, lower - y)))
          return false;
    return true;
  }
  std::size_t tile_at(int x, int y) const {
    return static_cast<std::size_t>(y / kTile) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(x / kTile);
  }
  static int bit_at(int x, int y) { return y % kTile * kTile + x % kTile; }
  /// Bits from one to another, of the eight there are.
  static std::uint64_t bits(int first, int last) {
    return 0xFFu >> (kTile - 1 - std::min(last, kTile - 1)) & 0xFFu << std::max(first, 0);
  }
  /// The same of bytes.
  static std::uint64_t rows(int first, int last) {
    return ~std::uint64_t{0} >> 8 * (kTile - 1 - std::min(last, kTile - 1)) &
           ~std::uint64_t{0} << 8 * std::max(first, 0);
  }
  static void set(std::atomic<std::uint64_t>& tile, std::uint64_t bits) {
    if ((~tile.load(std::memory_order_relaxed) & bits) != 0)
      tile.fetch_or(bits, std::memory_order_relaxed);
  }

  static constexpr std::uint64_t kColumn = 0x0101010101010101;
  static_assert(kTile == 8);

  int width_, height_, columns_;
  std::vector<std::atomic<std::uint64_t>> tiles_;
};

}  // namespace grelha
