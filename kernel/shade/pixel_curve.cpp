#include "kernel/shade/pixel_curve.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <utility>

#include "kernel/base/hash.hpp"

namespace grelha {
namespace {

/// A random order of four things.
struct OrderOfFour {
  std::uint32_t place[4] = {0, 1, 2, 3};

  explicit OrderOfFour(std::uint32_t hash) {
    for (std::uint32_t i = 3; i > 0; --i) {
      std::swap(place[i], place[(hash & 0xFFFFu) * (i + 1) >> 16]);
      hash = scattered_bits(hash);
    }
  }
};

class PixelCurve {
 public:
  PixelCurve(int width, int height, std::uint32_t seed)
      : width_(width), height_(height), seed_(scattered_bits(seed)) {
    positions_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  }

  /// The square of 2^level pixels a side whose upper left one is (x, y), and whose first position
  /// is `first`.
  void order_square(int x, int y, int level, std::uint32_t first) {
    if (x >= width_ || y >= height_)
      return;
    if (level == 0) {
      positions_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                 static_cast<std::size_t>(x)] = first;
      return;
    }
    const std::uint32_t key = first + static_cast<std::uint32_t>(level);
    const OrderOfFour order(scattered_bits(seed_ ^ scattered_bits(key)));
    const int half = 1 << (level - 1);
    for (int i = 0; i < 4; ++i)
      order_square(x + i % 2 * half,
                   y + i / 2 * half,
                   level - 1,
                   first + (order.place[i] << 2 * (level - 1)));
  }

  std::vector<std::uint32_t> take() { return std::move(positions_); }

 private:
  int width_, height_;
  std::uint32_t seed_;
  std::vector<std::uint32_t> positions_;
};

}  // namespace

std::vector<std::uint32_t> drawing_places(int width, int height, std::uint32_t seed) {
  PixelCurve curve(width, height, seed);
  curve.order_square(0, 0, std::bit_width(static_cast<unsigned>(std::max(width, height)) - 1), 0);
  return curve.take();
}

}  // namespace grelha
