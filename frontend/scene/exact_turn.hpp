#pragma once

#include <cmath>

namespace grelha {

struct Point2 {
  double x = 0, y = 0;
  bool operator==(const Point2&) const = default;
};

/// The order in which a line sweeps over the plane: by x and, where x is equal, by y.
inline bool swept_before(const Point2& a, const Point2& b) {
  return a.x < b.x || (a.x == b.x && a.y < b.y);
}

/// Twice the signed area of a, b, c; positive when they turn left. Exact in sign for float
/// coordinates of like size.
inline double turn(const Point2& a, const Point2& b, const Point2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The sign of the same by the sum of its six products, without rounding.
int exactly_summed_turn(const Point2& a, const Point2& b, const Point2& c);

/// The sign of the same, exact for all doubles whose products neither over- nor underflow: 1, 0 or
/// -1. Adds the products without rounding if rounding could change the sign (Shewchuk 1997).
inline int exact_turn(const Point2& a, const Point2& b, const Point2& c) {
  constexpr double kRounding = 3.3306690738754716e-16;  // (3 + 16u) u of the two products' sizes
  const double left = (b.x - a.x) * (c.y - a.y), right = (b.y - a.y) * (c.x - a.x);
  const double difference = left - right, bound = kRounding * (std::abs(left) + std::abs(right));
  if (difference > bound)
    return 1;
  return difference < -bound ? -1 : exactly_summed_turn(a, b, c);
}

}  // namespace grelha
