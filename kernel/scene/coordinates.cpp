#include "grelha/coordinates.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace grelha {
namespace {

/// Largest distance from the origin to a box's middle, in sizes of the box.
constexpr double kMaxRatio = 4;

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

Triangles triangles_of(std::span<const Float3> vertices,
                       std::span<const std::array<std::uint32_t, 3>> faces) {
  Triangles made;
  for (const Float3& p : vertices) {
    made.x.push_back(p.x);
    made.y.push_back(p.y);
    made.z.push_back(p.z);
  }
  for (const auto& [a, b, c] : faces) {
    made.a.push_back(a);
    made.b.push_back(b);
    made.c.push_back(c);
  }
  return made;
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

Coordinates coordinates_of(const float* points, std::ptrdiff_t stride, std::size_t count) {
  return StridedPoints<float>(points, stride, count).less({});
}

Coordinates coordinates_of(const double* points, std::ptrdiff_t stride, std::size_t count) {
  const StridedPoints<double> all(points, stride, count);
  PointBounds bounds;
  all.each([&](std::size_t a, std::size_t, double value) { bounds.add(a, value); });
  return all.less(bounds.offset());
}

}  // namespace grelha
