#pragma once
// Which cells a triangle touches.

#include <cmath>

#include "kernel/shapes/box.hpp"

namespace grelha {

/// A cell grown by pad against a triangle: the plane, and each edge seen along the axes across
/// which the triangle spans several cells. Together with boxes that meet these are all the
/// separating axes, so what is left is touched.
class TriangleTouch {
 public:
  TriangleTouch(const float (&corner)[3][3], const CellFrame& g, const CellRange& range) {
    double v[3][3], e[3][3], half[3];
    for (int a = 0; a < 3; ++a) {
      cell_[a] = g.cell[a];
      half[a] = g.cell[a] / 2 + g.pad;
      for (int k = 0; k < 3; ++k)
        v[k][a] = corner[k][a] - g.lo[a];
      for (int k = 0; k < 3; ++k)
        e[k][a] = v[(k + 1) % 3][a] - v[k][a];
    }
    double offset = 0, reach = 0, rounding[3];
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, d = (a + 2) % 3;
      const double p = e[0][d] * e[2][b], q = e[0][b] * e[2][d];
      n_[a] = p - q;
      rounding[a] = (std::abs(p) + std::abs(q)) * 1e-14;
      offset += n_[a] * v[0][a];
      reach += std::abs(n_[a]) * half[a];
    }
    offset_ = offset;
    reach_ = reach + std::abs(offset) * 1e-12;
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, d = (a + 2) % 3;
      if (range.lo[b] == range.hi[b] || range.lo[d] == range.hi[d])
        continue;  // one row of cells: its box says it all
      const double sign = n_[a] < 0 ? -1 : 1;
      // inward across the edge; rounding can turn it only where the triangle is seen edge-on
      for (int k = 0; k < 3; ++k) {
        const double mb = -sign * e[k][d], md = sign * e[k][b];
        const double at = mb * v[k][b] + md * v[k][d];
        edges_[count_++] = {b,
                            d,
                            mb,
                            md,
                            at - (std::abs(mb) * half[b] + std::abs(md) * half[d]) - rounding[a] -
                                std::abs(at) * 1e-12};
      }
    }
  }
  bool operator()(const int (&at)[3]) const {
    const double c[3] = {(at[0] + .5) * cell_[0], (at[1] + .5) * cell_[1], (at[2] + .5) * cell_[2]};
    if (!(std::abs(n_[0] * c[0] + n_[1] * c[1] + n_[2] * c[2] - offset_) <= reach_))
      return false;
    for (int i = 0; i < count_; ++i)
      if (edges_[i].mb * c[edges_[i].b] + edges_[i].md * c[edges_[i].d] < edges_[i].least)
        return false;
    return true;
  }

 private:
  struct Edge {
    int b, d;  ///< axes it is seen in
    double mb, md, least;
  };
  double cell_[3], n_[3], offset_, reach_;
  int count_ = 0;
  Edge edges_[9];
};

}  // namespace grelha
