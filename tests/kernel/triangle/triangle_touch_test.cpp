// Which cells a triangle touches: needles, whose normals rounding spoils.

#include "kernel/triangle/triangle_touch.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/random.hpp"

namespace grelha::test {
namespace {

constexpr int kCells = 32;

/// Corners of a needle from near the origin into a cube of side 1, the third of them on the long
/// edge but for rounding to floats; of a hundred thousand the flattest.
struct Needle {
  float corner[3][3];
  double flatness;  ///< of the normal, of its products
};

Needle random_needle(Random& random) {
  Needle n;
  const double share = random.log_in(1e-6, .9);
  for (int a = 0; a < 3; ++a) {
    n.corner[0][a] = static_cast<float>(random.log_in(1e-12, 1e-3));
    n.corner[1][a] = static_cast<float>(random.in(.5, 1));
    const double to = static_cast<double>(n.corner[1][a]) - n.corner[0][a];
    n.corner[2][a] = static_cast<float>(n.corner[0][a] + share * to);
  }
  n.flatness = 0;
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, d = (a + 2) % 3;
    using Long = long double;
    const auto side = [&](int k, int axis) { return Long(n.corner[k][axis]) - n.corner[0][axis]; };
    const Long p = side(1, b) * side(2, d), q = side(1, d) * side(2, b);
    n.flatness = std::max(n.flatness, static_cast<double>(std::abs(p - q) / (p + q)));
  }
  return n;
}

/// Every cell that a point of a needle lies in is touched.
TEST(TriangleTouch, HoldsNeedles) {
  const CellFrame frame{{0, 0, 0}, {1. / kCells, 1. / kCells, 1. / kCells}, 0x1p-16};
  const CellRange range{{0, 0, 0}, {kCells - 1, kCells - 1, kCells - 1}};
  double flattest = 1;
  int lost = 0;
  for (std::uint64_t seed = 0; seed < 2000000; ++seed) {
    Random random(seed);
    const Needle n = random_needle(random);
    flattest = std::min(flattest, n.flatness);
    if (n.flatness > 1e-9)
      continue;
    const TriangleTouch touch(n.corner, frame, range);
    for (int i = 0; i <= 500; ++i) {
      int at[3];
      for (int a = 0; a < 3; ++a) {
        const double place = n.corner[0][a] + i * .002 * (n.corner[1][a] - n.corner[0][a]);
        at[a] = std::min(static_cast<int>(place * kCells), kCells - 1);
      }
      lost += !touch(at);
    }
  }
  EXPECT_EQ(lost, 0);
  std::printf("needles: flattest %g\n", flattest);
}

}  // namespace
}  // namespace grelha::test
