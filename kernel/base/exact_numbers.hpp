#pragma once
// Exact numbers, as sums of doubles that do not overlap and as wide integers, and numbers of 106
// bits between doubles and these.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>

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

// Numbers of 106 bits, as sums of two doubles: Dekker 1971; Hida, Li, Bailey, "Algorithms for
// Quad-Double Precision Floating Point Arithmetic", 2001.

/// + and - are within 2^-104 of the sum of their terms' magnitudes, *, / and square_root() within
/// 2^-100 of themselves.
struct DoubleDouble {
  double high = 0;
  double low = 0;

  DoubleDouble() = default;
  DoubleDouble(double x) : high(x) {}  // NOLINT: a double is one
  DoubleDouble(double x, double rest) : high(x + rest), low(rest - ((x + rest) - x)) {}
  explicit DoubleDouble(const Expansion& e) : DoubleDouble(e.estimate(), e.rest()) {}

  friend DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
    double high = 0;
    double low = 0;
    double high_of_rest = 0;
    double low_of_rest = 0;
    two_sum(a.high, b.high, high, low);
    two_sum(a.low, b.low, high_of_rest, low_of_rest);
    const DoubleDouble sum(high, low + high_of_rest);
    return {sum.high, sum.low + low_of_rest};
  }
  friend DoubleDouble operator-(const DoubleDouble& a) { return {-a.high, -a.low}; }
  friend DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }
  friend DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
    double high = 0;
    double low = 0;
    two_product(a.high, b.high, high, low);
    return {high, low + (a.high * b.low + a.low * b.high)};
  }
  friend DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
    const double first = a.high / b.high;
    const DoubleDouble left = a - b * first;
    const double second = left.high / b.high;
    const DoubleDouble left_then = left - b * second;
    return DoubleDouble(first, second) + left_then.high / b.high;
  }
  friend bool operator<(const DoubleDouble& a, const DoubleDouble& b) {
    return a.high < b.high || (a.high == b.high && a.low < b.low);
  }
  friend bool operator>(const DoubleDouble& a, const DoubleDouble& b) { return b < a; }
};

/// NaN of less than 0.
inline DoubleDouble square_root(const DoubleDouble& a) {
  const double x = std::sqrt(a.high);
  if (!(x > 0))
    return x;
  const DoubleDouble left = a - DoubleDouble(x) * x;
  return {x, left.high / (2 * x)};
}
inline DoubleDouble magnitude(const DoubleDouble& a) {
  return a < 0 ? -a : a;
}

struct WideVector {
  DoubleDouble x, y, z;
};

inline WideVector operator+(const WideVector& a, const WideVector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline WideVector operator-(const WideVector& a, const WideVector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline WideVector operator*(const DoubleDouble& s, const WideVector& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline WideVector cross(const WideVector& a, const WideVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline DoubleDouble dot(const WideVector& a, const WideVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Integers of 128 bits, for exact products of three lengths that are no wider apart than floats of
// one mesh are.

__extension__ using Int128 = __int128;

/// Three numbers as integers times a power of two.
struct IntegerVector {
  std::int64_t at[3];
};

/// Divides vectors by the power of two that leaves them less than 2^bits, and keeps it. Returns
/// false if that leaves a number that is no integer, if all are 0, and of 2^100 or more.
template <std::size_t kCount>
bool to_integers(const double (&v)[kCount][3],
                 int bits,
                 IntegerVector (&integers)[kCount],
                 double& unit) {
  double largest = 0;
  for (const auto& p : v)
    for (const double x : p)
      largest = std::abs(x) > largest ? std::abs(x) : largest;
  if (!(largest > 0 && largest < 0x1p100))
    return false;
  std::uint64_t field;  // of the exponent; `largest` is no denormal
  std::memcpy(&field, &largest, sizeof field);
  field = ((field >> 52) + 1 - static_cast<std::uint64_t>(bits)) << 52;
  std::memcpy(&unit, &field, sizeof unit);
  const double inverse = 1 / unit;
  bool whole = true;
  for (std::size_t i = 0; i < kCount; ++i)
    for (std::size_t a = 0; a < 3; ++a) {
      const double scaled = v[i][a] * inverse;
      whole = whole && std::trunc(scaled) == scaled;  // no NaN
      integers[i].at[a] = whole ? static_cast<std::int64_t>(scaled) : 0;
    }
  return whole;
}

struct WideIntegerVector {
  Int128 x, y, z;
};
inline WideIntegerVector cross(const IntegerVector& p, const IntegerVector& q) {
  const auto& a = p.at;
  const auto& b = q.at;
  return {Int128{a[1]} * b[2] - Int128{a[2]} * b[1],
          Int128{a[2]} * b[0] - Int128{a[0]} * b[2],
          Int128{a[0]} * b[1] - Int128{a[1]} * b[0]};
}
inline Int128 dot(const WideIntegerVector& p, const IntegerVector& q) {
  return p.x * q.at[0] + p.y * q.at[1] + p.z * q.at[2];
}
inline int sign_of(Int128 n) {
  return n < 0 ? -1 : n > 0 ? 1 : 0;
}
/// The number, within 2^-51 of itself.
inline double double_of(Int128 n) {
  const Int128 size = n < 0 ? -n : n;
  const double d = static_cast<double>(static_cast<std::int64_t>(size >> 64)) * 0x1p64 +
                   static_cast<double>(static_cast<std::uint64_t>(size));
  return n < 0 ? -d : d;
}
/// The sign of a b - c d.
inline int compare_products(Int128 a, Int128 b, Int128 c, Int128 d) {
  using Word = std::uint64_t;
  __extension__ using Wide = unsigned __int128;
  struct Product {
    Wide high, low;
    int sign;
  };
  const auto product = [](Int128 x, Int128 y) {
    const int sign = sign_of(x) * sign_of(y);
    const Wide p = static_cast<Wide>(x < 0 ? -x : x), q = static_cast<Wide>(y < 0 ? -y : y);
    const Word p0 = static_cast<Word>(p), p1 = static_cast<Word>(p >> 64);
    const Word q0 = static_cast<Word>(q), q1 = static_cast<Word>(q >> 64);
    const Wide low = Wide{p0} * q0, high = Wide{p1} * q1;
    const Wide middle = Wide{p0} * q1 + (low >> 64);  // < 2^128
    const Wide other = Wide{p1} * q0 + static_cast<Word>(middle);
    return Product{
        high + (middle >> 64) + (other >> 64), (other << 64) | static_cast<Word>(low), sign};
  };
  const Product x = product(a, b), y = product(c, d);
  if (x.sign != y.sign)
    return x.sign < y.sign ? -1 : 1;
  const int larger = x.high != y.high ? (x.high > y.high ? 1 : -1)
                     : x.low != y.low ? (x.low > y.low ? 1 : -1)
                                      : 0;
  return larger * x.sign;
}
/// n times a power of two.
inline Expansion expansion_of(Int128 n, double unit) {
  const Int128 size = n < 0 ? -n : n;
  const std::uint64_t half[] = {static_cast<std::uint64_t>(size),
                                static_cast<std::uint64_t>(size >> 64)};
  Expansion sum;
  double scale = n < 0 ? -unit : unit;
  for (const std::uint64_t h : half)
    for (const std::uint32_t part :
         {static_cast<std::uint32_t>(h), static_cast<std::uint32_t>(h >> 32)}) {
      sum.add(part * scale);
      scale *= 0x1p32;
    }
  return sum;
}

}  // namespace grelha
