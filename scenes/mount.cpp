// The fractal mountain: a square whose midpoints are displaced at random, again and again.
#include <cmath>
#include <cstdint>

#include "scenes/generators.hpp"
#include "scenes/nff_writer.hpp"

namespace grelha::scenes {

namespace {

/// SPD's normal deviate: Box and Muller's polar method over a small congruential generator.
double deviate(std::int64_t seed) {
  constexpr std::int64_t kFactor = 8121, kAddend = 28411, kModulus = 134456;
  double v1, v2, r;
  do {
    const std::int64_t i1 = (kAddend + seed * kFactor) % kModulus;
    seed = (kAddend + i1 * kFactor) % kModulus;
    v1 = 2 * double(i1) / double(kModulus) - 1;
    v2 = 2 * double(seed) / double(kModulus) - 1;
    r = v1 * v1 + v2 * v2;
  } while (r >= 1);
  return v1 * std::sqrt(-2 * std::log(r) / r);
}

class Mountain {
 public:
  Mountain(NffWriter& nff, int size) : nff_(nff), size_(size), cells_(1 << size) {}

  void write() { square(0, 0, cells_, 0, 0, 0, 0); }

 private:
  /// Corner heights: a low left, b low right, c up right, d up left.
  void square(int x, int y, int width, double a, double b, double c, double d) {
    if (width == 1)
      return triangles(x, y, a, b, c, d);
    const int half = width / 2;
    const double rise = half * (2.0 / cells_) * roughness_;
    const double low = (a + b) / 2 + rise * deviate(seed(x + half, y));
    const double right = (b + c) / 2 + rise * deviate(seed(x + width, y + half));
    const double up = (c + d) / 2 + rise * deviate(seed(x + half, y + width));
    const double left = (d + a) / 2 + rise * deviate(seed(x, y + half));
    const double center =
        (a + b + c + d) / 4 + 1.4142136 * rise * deviate(seed(x + half, y + half));
    square(x, y, half, a, low, center, left);
    square(x + half, y, half, low, b, right, center);
    square(x + half, y + half, half, center, right, c, up);
    square(x, y + half, half, left, center, up, d);
  }

  void triangles(int x, int y, double a, double b, double c, double d) {
    const Vec low_left = point(x, y, a), low_right = point(x + 1, y, b);
    const Vec up_right = point(x + 1, y + 1, c), up_left = point(x, y + 1, d);
    nff_.polygon({low_left, low_right, up_right});
    nff_.polygon({up_right, up_left, low_left});
  }

  Vec point(int x, int y, double height) const {
    return {-1 + 2.0 * x / cells_, -1 + 2.0 * y / cells_, height};
  }

  /// The same for a point whichever square asks, so that neighbours fit. SPD takes X twice, a slip
  /// that files keep. Its third shift is negative from size 8 on, which C leaves undefined: we
  /// shift right there.
  std::int64_t seed(std::int64_t x, std::int64_t y) const {
    const std::int64_t low = size_ <= 7 ? x << (7 - size_) : x >> (size_ - 7);
    return 21 + ((x << (23 - size_)) + (y << (15 - size_)) + low) % 65536;
  }

  static double roughness() {
    const double q = 2 / std::pow(2, 1 / 1.2);  // fractal dimension 2.2
    return std::sqrt(q * q - 1);
  }

  NffWriter& nff_;
  const int size_, cells_;
  const double roughness_ = roughness();
};

/// Four balls that touch each other, one on top of three.
void write_balls_of_glass(NffWriter& nff, bool spd) {
  const Vec middle{-0.8, 0.8, 1};
  const double radius = 0.17;
  const Vec top{0, 0, radius * std::sqrt(1.5)};
  const Vec lower = turn(top, normalise({1, 1, 0}), std::acos(-1.0 / 3.0));
  nff.surface({.color = {1, 1, 1},
               .kd = 0.1,
               .ks = 0.1,
               .shine = 101.148,
               .transmission = 0.9,
               .ior = spd ? 1.5 : 1.2});
  nff.sphere(middle + top, radius);
  for (int third = 0; third < 3; ++third)
    nff.sphere(middle + turn(lower, {0, 0, 1}, degrees(120.0 * third)),
               spd ? radius : radius - 0.001 * (third + 1));
}

}  // namespace

void write_mount(std::ostream& out, const SceneOptions& options) {
  NffWriter nff(out);
  nff.background({0.078, 0.361, 0.753});
  nff.view({.from = {-1.6, 1.6, 1.7}, .at = {0, 0, 0}});
  if (options.spd)
    nff.light({-100, -100, 100});
  else
    nff.light({-100, -100, 100}, {1, 1, 1});
  write_balls_of_glass(nff, options.spd);
  nff.surface({.color = {0.5, 0.45, 0.35}, .kd = 1, .shine = 100000});
  Mountain(nff, options.size).write();
}

}  // namespace grelha::scenes
