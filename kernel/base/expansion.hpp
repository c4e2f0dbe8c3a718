#pragma once
// Numbers that no rounding changes: sums of doubles that do not overlap. Shewchuk, "Adaptive
// Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997.

#include <cmath>
#include <cstddef>
#include <cstring>

namespace grelha {

/// x y = high + low. Dekker, "A Floating-Point Technique for Extending the Available Precision",
/// 1971; exact where no part leaves the range of doubles.
inline void two_product(double x, double y, double& high, double& low) {
  constexpr double kSplitter = 134217729;
  const double p = kSplitter * x;
  const double q = kSplitter * y;
  const double x1 = p - (p - x);
  const double x2 = x - x1;
  const double y1 = q - (q - y);
  const double y2 = y - y1;
  high = x * y;
  low = ((x1 * y1 - high) + x1 * y2 + x2 * y1) + x2 * y2;
}

/// x + y = high + low, exactly. Knuth, TAOCP 2, 4.2.2.
inline void two_sum(double x, double y, double& high, double& low) {
  high = x + y;
  const double of_y = high - x;
  low = (x - (high - of_y)) + (y - of_y);
}

/// An exact number. Products of up to seven floats, and their differences, stay in range: they are
/// multiples of 2^-1043 below 2^1000.
class Expansion {
 public:
  /// Compressed, each part is less than a last place of the next: doubles have 2100 bits, and so 40
  /// parts.
  static constexpr int kMost = 64;

  Expansion() = default;
  Expansion(const Expansion& e) { *this = e; }
  Expansion& operator=(const Expansion& e) {
    count_ = e.count_;
    is_lost_ = e.is_lost_;
    std::memmove(part_, e.part_, static_cast<std::size_t>(count_) * sizeof(double));
    return *this;
  }
  explicit Expansion(double x) { add(x); }
  static Expansion difference(double x, double y) {
    Expansion e(x);
    e.add(-y);
    return e;
  }

  void add(double x) {
    if (is_lost_ || x == 0)
      return;
    if (count_ == kMost)
      compress();
    int count = 0;
    for (int i = 0; i < count_; ++i) {
      double low = 0;
      two_sum(x, part_[i], x, low);
      if (low != 0)
        part_[count++] = low;
    }
    if (x != 0)
      part_[count++] = x;
    count_ = count;
    is_lost_ = !std::isfinite(x);
  }
  void add_product(double x, double y) {
    double high = 0;
    double low = 0;
    two_product(x, y, high, low);
    add(low);
    add(high);
  }

  Expansion& operator+=(const Expansion& e) {
    for (int i = 0; i < e.count_; ++i)
      add(e.part_[i]);
    return *this;
  }
  Expansion& operator-=(const Expansion& e) {
    for (int i = 0; i < e.count_; ++i)
      add(-e.part_[i]);
    return *this;
  }
  friend Expansion operator*(const Expansion& a, double x) {
    Expansion product;
    for (int i = 0; i < a.count_; ++i)
      product.add_product(a.part_[i], x);
    return product;
  }
  friend Expansion operator*(const Expansion& a, const Expansion& b) {
    Expansion product;
    for (int j = 0; j < b.count_; ++j)
      for (int i = 0; i < a.count_; ++i)
        product.add_product(a.part_[i], b.part_[j]);
    return product;
  }
  friend Expansion operator+(Expansion a, const Expansion& b) { return a += b; }
  friend Expansion operator-(Expansion a, const Expansion& b) { return a -= b; }

  /// -1, 0 or 1; 0 if the number left the range. The last part is larger than all others together.
  int sign() const {
    if (count_ == 0 || is_lost_)
      return 0;
    return part_[count_ - 1] < 0 ? -1 : 1;
  }
  /// The number, within 2^-52 of itself.
  double estimate() const {
    double sum = is_lost_ ? std::nan("") : 0;
    for (int i = 0; i < count_; ++i)
      sum += part_[i];
    return sum;
  }
  /// The number minus estimate(), within 2^-52 of itself.
  double rest() const {
    Expansion e = *this;
    e.add(-estimate());
    return e.estimate();
  }

 private:
  /// Shewchuk's Compress, figure 15: the same sum in as few parts as it takes.
  void compress() {
    double found[kMost];
    int bottom = count_ - 1;
    double sum = part_[bottom];
    for (int i = count_ - 2; i >= 0; --i) {
      double rest = 0;
      two_sum(sum, part_[i], sum, rest);
      if (rest != 0) {
        found[bottom--] = sum;
        sum = rest;
      }
    }
    found[bottom] = sum;
    int top = 0;
    for (int i = bottom + 1; i < count_; ++i) {
      double rest = 0;
      two_sum(found[i], sum, sum, rest);
      if (rest != 0)
        part_[top++] = rest;
    }
    part_[top++] = sum;
    count_ = top;
  }

  double part_[kMost];
  int count_ = 0;
  bool is_lost_ = false;  ///< a part is no number: it left the range
};

struct ExactVector {
  Expansion x, y, z;
};

/// Of floats or doubles.
template <class A, class B>
ExactVector difference(const A (&a)[3], const B (&b)[3]) {
  return {Expansion::difference(a[0], b[0]),
          Expansion::difference(a[1], b[1]),
          Expansion::difference(a[2], b[2])};
}
inline ExactVector cross(const ExactVector& a, const ExactVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Expansion dot(const ExactVector& a, const ExactVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Expansion dot(const ExactVector& a, const double (&b)[3]) {
  return a.x * b[0] + a.y * b[1] + a.z * b[2];
}

}  // namespace grelha
