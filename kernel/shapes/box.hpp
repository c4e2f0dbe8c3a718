#pragma once
// Boxes that primitives lie in, and the cells that they are put into.

#include <cmath>

namespace grelha {

/// Axis-aligned box in double, where sums of floats do not round. Empty when lo > hi.
struct Box {
  double lo[3] = {1e300, 1e300, 1e300}, hi[3] = {-1e300, -1e300, -1e300};
  void add(double x, double y, double z) {
    const double p[3] = {x, y, z};
    for (int a = 0; a < 3; ++a) {
      if (p[a] < lo[a])
        lo[a] = p[a];
      if (p[a] > hi[a])
        hi[a] = p[a];
    }
  }
  void add(const Box& b) {
    add(b.lo[0], b.lo[1], b.lo[2]);
    add(b.hi[0], b.hi[1], b.hi[2]);
  }
  bool empty() const { return !(lo[0] <= hi[0]); }
  void grow(double by) {
    for (int a = 0; a < 3; ++a) {
      lo[a] -= by;
      hi[a] += by;
    }
  }
  double diagonal() const {
    if (empty())
      return 0;
    double sum = 0;
    for (int a = 0; a < 3; ++a)
      sum += (hi[a] - lo[a]) * (hi[a] - lo[a]);
    return std::sqrt(sum);
  }
};

/// Corner and size of the cells of a grid. Everything within `pad` of a cell belongs to it.
struct CellFrame {
  double lo[3], cell[3];  ///< corner of the first, size of each
  double pad;
};

/// Cells along each axis, the last included.
struct CellRange {
  int lo[3], hi[3];
  bool is_one() const { return lo[0] == hi[0] && lo[1] == hi[1] && lo[2] == hi[2]; }
};

}  // namespace grelha
