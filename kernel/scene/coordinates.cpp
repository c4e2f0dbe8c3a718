#include "grelha/coordinates.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace grelha {
namespace {

/// Largest distance from the origin to a box's middle, in sizes of the box.
constexpr double kMaxRatio = 4;

}  // namespace

void PointArray::expect_array() const {
  if (count > 0 && (!data || stride == 0))
    throw std::invalid_argument(std::string(name) +
                                (data ? ": expected a stride of bytes from one to the next, found 0"
                                      : ": expected a pointer, found null"));
}

void PointBounds::add(std::size_t axis, double value) {
  low_[axis] = std::min(low_[axis], value);
  high_[axis] = std::max(high_[axis], value);
}

std::array<double, 3> PointBounds::offset() const {
  std::array<double, 3> middle{};
  double size = 0;
  double far = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    middle[a] = .5 * (low_[a] + high_[a]);
    size = std::max(size, high_[a] - low_[a]);
    far = std::max(far, std::abs(middle[a]));
  }
  if (!(far > kMaxRatio * size) || far == kInfinity)
    return {};
  // no finer than doubles are there, if the size vanishes
  const double step = std::ldexp(1, std::ilogb(std::max(size, 0x1p-30 * far)) + 1);
  for (double& at : middle)
    at = step * std::nearbyint(at / step);
  return middle;
}

}  // namespace grelha
