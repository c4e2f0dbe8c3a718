#include "grelha/coordinates.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace grelha {
namespace {

template <class Number>
class StridedPoints {
 public:
  StridedPoints(const Number* points, std::ptrdiff_t stride, std::size_t count)
      : bytes_(reinterpret_cast<const char*>(points)), stride_(stride), count_(count) {
    if (!points && count != 0)
      throw std::invalid_argument("points: expected an array, found null");
  }

  /// Calls visit(axis, i, value) for each coordinate.
  template <class Visit>
  void each(const Visit& visit) const {
    for (std::size_t i = 0; i < count_; ++i) {
      Number point[3];
      std::memcpy(point, bytes_ + static_cast<std::ptrdiff_t>(i) * stride_, sizeof point);
      for (std::size_t a = 0; a < 3; ++a)
        visit(a, i, double{point[a]});
    }
  }

  Coordinates less(const std::array<double, 3>& offset) const {
    Coordinates found;
    found.offset = offset;
    std::vector<float>* const axes[3] = {&found.x, &found.y, &found.z};
    for (std::vector<float>* const axis : axes)
      axis->resize(count_);
    each([&](std::size_t a, std::size_t i, double value) {
      (*axes[a])[i] = static_cast<float>(value - offset[a]);
    });
    return found;
  }

 private:
  const char* bytes_;
  std::ptrdiff_t stride_;
  std::size_t count_;
};

}  // namespace

std::array<double, 3> offset_of(const std::array<double, 3>& low,
                                const std::array<double, 3>& high) {
  double size = 0;
  double far = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    size = std::max(size, high[a] - low[a]);
    far = std::max({far, std::abs(low[a]), std::abs(high[a])});
  }
  if (!(far > 0))
    return {};
  // no finer than doubles are there, if the size vanishes
  const double step = std::ldexp(1, std::ilogb(std::max(size, 0x1p-30 * far)) + 1);
  std::array<double, 3> found{};
  for (std::size_t a = 0; a < 3; ++a)
    found[a] = step * std::nearbyint(.5 * (low[a] + high[a]) / step);
  return found;
}

Coordinates coordinates_of(const float* points, std::ptrdiff_t stride, std::size_t count) {
  return StridedPoints<float>(points, stride, count).less({});
}

Coordinates coordinates_of(const double* points, std::ptrdiff_t stride, std::size_t count) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const StridedPoints<double> all(points, stride, count);
  std::array<double, 3> low{kInfinity, kInfinity, kInfinity};
  std::array<double, 3> high{-kInfinity, -kInfinity, -kInfinity};
  bool exact = true;
  all.each([&](std::size_t a, std::size_t, double value) {
    low[a] = std::min(low[a], value);
    high[a] = std::max(high[a], value);
    exact = exact && double{static_cast<float>(value)} == value;
  });
  return all.less(exact ? std::array<double, 3>{} : offset_of(low, high));
}

}  // namespace grelha
