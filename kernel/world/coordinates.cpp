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

std::array<double, 3> PointBounds::middle() const {
  std::array<double, 3> middle{};
  for (std::size_t a = 0; a < 3; ++a)
    middle[a] = .5 * (low_[a] + high_[a]);
  return middle;
}

double PointBounds::size() const {
  double size = 0;
  for (std::size_t a = 0; a < 3; ++a)
    size = std::max(size, high_[a] - low_[a]);
  return size;
}

double PointBounds::distance(const std::array<double, 3>& point) const {
  double far = 0;
  for (std::size_t a = 0; a < 3; ++a)
    far = std::max(far, std::abs(middle()[a] - point[a]));
  return far;
}

std::array<double, 3> PointBounds::offset(const std::array<double, 3>& before) const {
  const double near = kMaxRatio * size(), far = distance({});
  if (!(distance(before) > near))
    return before;
  if (!(far > near) || far == kInfinity)
    return {};
  // no finer than doubles are there, if the size vanishes
  const double step = std::ldexp(1, std::ilogb(std::max(size(), 0x1p-30 * far)) + 1);
  std::array<double, 3> offset = middle();
  for (double& at : offset)
    at = step * std::nearbyint(at / step);
  return offset;
}

}  // namespace grelha
