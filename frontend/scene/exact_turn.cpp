#include "frontend/scene/exact_turn.hpp"

#include <cmath>
#include <cstddef>

namespace grelha {
namespace {

/// A sum without rounding: parts that do not overlap, each smaller than the one behind it.
class ExactSum {
 public:
  /// Adds both parts of a product.
  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }
  int sign() const {
    const double largest = count_ == 0 ? 0 : parts_[count_ - 1];
    return (largest > 0) - (largest < 0);
  }

 private:
  void add(double value) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const double sum = value + parts_[i], shared = sum - value,
                   error = (value - (sum - shared)) + (parts_[i] - shared);
      if (error != 0)
        parts_[count++] = error;
      value = sum;
    }
    count_ = count;
    if (value != 0)
      parts_[count_++] = value;
  }

  static constexpr std::size_t kMost = 12;  // of six products
  double parts_[kMost];
  std::size_t count_ = 0;
};

}  // namespace

int exactly_summed_turn(const Point2& a, const Point2& b, const Point2& c) {
  if (a == b || b == c || c == a)
    return 0;
  ExactSum sum;
  sum.add_product(b.x, c.y);
  sum.add_product(-b.x, a.y);
  sum.add_product(-a.x, c.y);
  sum.add_product(-b.y, c.x);
  sum.add_product(b.y, a.x);
  sum.add_product(a.y, c.x);
  return sum.sign();
}

}  // namespace grelha
