#include "kernel/subdivision/tile_sums.hpp"

#include <cmath>

namespace grelha {
namespace {

double sum_of(const Float3 (&c)[4], float Float3::*channel) {
  const double upper = static_cast<double>(c[0].*channel) + c[1].*channel;
  const double lower = static_cast<double>(c[2].*channel) + c[3].*channel;
  return upper + lower;
}

}  // namespace

TileSums::TileSums(const TileRect& rect)
    : rect_(rect), sums_(width() * static_cast<std::size_t>(rect.y1 - rect.y0)) {}

void TileSums::add(std::uint32_t pixel, const Float3 (&corners)[4], int level) {
  const double share = std::ldexp(.25, -2 * level);
  Sum& sum = sums_[pixel];
  sum.r += share * sum_of(corners, &Float3::x);
  sum.g += share * sum_of(corners, &Float3::y);
  sum.b += share * sum_of(corners, &Float3::z);
}

void TileSums::show(Image& image) const {
  const Sum* sum = sums_.data();
  for (int y = rect_.y0; y < rect_.y1; ++y) {
    float* out = image.row(y) + 3 * static_cast<std::size_t>(rect_.x0);
    for (int x = rect_.x0; x < rect_.x1; ++x, ++sum, out += 3) {
      out[0] = static_cast<float>(sum->r);
      out[1] = static_cast<float>(sum->g);
      out[2] = static_cast<float>(sum->b);
    }
  }
}

}  // namespace grelha
