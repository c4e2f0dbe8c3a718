// Which cells a triangle overlaps: needles, whose normals rounding spoils.

#include "kernel/shapes/triangle.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/random.hpp"

namespace grelha::test {
namespace {

constexpr int kCells = 32;

/// Every cell that a point of a needle lies in is overlapped. Two corners lie on a line through the
/// origin, the third so near the origin that what is left of the normal is a rounding or some.
TEST(TriangleOverlap, HoldsNeedles) {
  const CellFrame frame{{0, 0, 0}, {1. / kCells, 1. / kCells, 1. / kCells}, 0x1p-16};
  const CellRange range{{0, 0, 0}, {kCells - 1, kCells - 1, kCells - 1}};
  int lost = 0;
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    Random random(seed);
    float corner[3][3];
    const double near = random.log_in(1e-17, 1e-9);
    for (int a = 0; a < 3; ++a) {
      corner[0][a] = static_cast<float>(near * random.unit());
      corner[1][a] = static_cast<float>(random.in(.05, 1));
      corner[2][a] = corner[1][a] * (random.chance(.5) ? .5f : 0x1p-20f);
    }
    if (random.chance(.5))
      std::swap(corner[0], corner[1]);
    const TriangleOverlap touch(corner, frame, range);
    const int far = corner[1][0] > corner[0][0] ? 1 : 0;
    for (int i = 0; i <= 200; ++i) {
      int at[3];
      for (int a = 0; a < 3; ++a)
        at[a] = std::min(static_cast<int>(i * .005 * corner[far][a] * kCells), kCells - 1);
      lost += !touch(at);
    }
  }
  EXPECT_EQ(lost, 0);
}

}  // namespace
}  // namespace grelha::test
