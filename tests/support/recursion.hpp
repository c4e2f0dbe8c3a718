#pragma once

#include "grelha/subdivision.hpp"

#include <array>
#include <functional>
#include <map>
#include <set>

namespace grelha::test {

using Place = std::pair<std::uint32_t, std::uint32_t>;
using Colour = std::function<Float3(double x, double y)>;  ///< of a point in pixels

/// The definition, plainly: one square at a time, each point looked up again wherever it is wanted.
class Recursion {
 public:
  Recursion(const Colour& colour, float threshold, int depth)
      : colour_(colour), threshold_(threshold), depth_(depth) {}

  std::array<double, 3> pixel(std::uint32_t x, std::uint32_t y) {
    return mean(256 * x, 256 * y, 256, depth_);
  }
  const std::set<Place>& points() const { return points_; }

 private:
  std::array<double, 3> at(std::uint32_t x, std::uint32_t y) {
    points_.insert({x, y});
    const Float3 c = colour_(x / 256., y / 256.);
    return {c.x, c.y, c.z};
  }

  std::array<double, 3> mean(std::uint32_t x, std::uint32_t y, std::uint32_t side, int depth) {
    std::array<std::array<double, 3>, 4> c{
        at(x, y), at(x + side, y), at(x, y + side), at(x + side, y + side)};
    double most = 0;
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b)
        for (std::size_t k = 0; k < 3; ++k)
          most = std::max(
              most,
              std::clamp(c[std::size_t(a)][k], 0., 1.) - std::clamp(c[std::size_t(b)][k], 0., 1.));
    if (depth > 0 && most > threshold_) {
      const std::uint32_t h = side / 2;
      c = {mean(x, y, h, depth - 1),
           mean(x + h, y, h, depth - 1),
           mean(x, y + h, h, depth - 1),
           mean(x + h, y + h, h, depth - 1)};
    }
    std::array<double, 3> sum{};
    for (const auto& part : c)
      for (std::size_t k = 0; k < 3; ++k)
        sum[k] += part[k] / 4;
    return sum;
  }

  const Colour& colour_;
  double threshold_;
  int depth_;
  std::set<Place> points_;
};

}  // namespace grelha::test
