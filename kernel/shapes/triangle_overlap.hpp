#pragma once
// Which cells a triangle overlaps.

#include <algorithm>
#include <cmath>

#include "kernel/shapes/box.hpp"

namespace grelha {

/// A cell grown by pad against a triangle: the plane, and each edge seen along the axes across
/// which the triangle spans several cells. Together with boxes that overlap, these are all the
/// separating axes, so the triangle overlaps the remaining cells.
class TriangleOverlap {
 public:
  TriangleOverlap(const float (&corner)[3][3], const CellFrame& g, const CellRange& range) {
    for (int a = 0; a < 3; ++a) {
      cell_[a] = g.cell[a];
      half_[a] = g.cell[a] / 2 + g.pad;
      for (int k = 0; k < 3; ++k)
        corner_[k][a] = corner[k][a] - g.lo[a];
      for (int k = 0; k < 3; ++k)
        side_[k][a] = static_cast<double>(corner[(k + 1) % 3][a]) - corner[k][a];
    }
    set_plane();
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3;
      const int d = (a + 2) % 3;
      // of one row of cells the box says it all
      if (range.lo[b] != range.hi[b] && range.lo[d] != range.hi[d])
        add_edges(a, b, d);
    }
  }
  bool operator()(const int (&at)[3]) const {
    const double c[3] = {(at[0] + .5) * cell_[0], (at[1] + .5) * cell_[1], (at[2] + .5) * cell_[2]};
    if (!(std::abs(n_[0] * c[0] + n_[1] * c[1] + n_[2] * c[2] - offset_) <= half_width_))
      return false;
    for (int i = 0; i < count_; ++i)
      if (edges_[i].mb * c[edges_[i].b] + edges_[i].md * c[edges_[i].d] < edges_[i].least)
        return false;
    return true;
  }

 private:
  /// Times the products whose difference a component of the normal is: their rounding in double,
  /// for two sides, a product and the difference. For needles it can exceed the result. Other
  /// roundings come to less than a thousandth of the pad, which all cells are grown by.
  static constexpr double kNormalError = 0x1p-51;

  struct Edge {
    int b, d;  ///< axes it is seen in
    double mb, md, least;
  };

  void set_plane() {
    double offset = 0;
    double half_width = 0;
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3;
      const int d = (a + 2) % 3;
      const double p = side_[0][d] * side_[2][b];
      const double q = side_[0][b] * side_[2][d];
      n_[a] = p - q;
      offset += n_[a] * corner_[0][a];
      const double from_corner =
          std::max(std::abs(side_[0][a]), std::abs(side_[2][a])) + 2 * half_[a];
      error_[a] = (std::abs(p) + std::abs(q)) * kNormalError;
      half_width += std::abs(n_[a]) * half_[a] + error_[a] * from_corner;
    }
    offset_ = offset;
    half_width_ = half_width;
  }

  /// The edges seen along axis a, inward across each. Rounding can turn them only where the
  /// triangle is seen edge-on: then all of it lies within that of each.
  void add_edges(int a, int b, int d) {
    const double sign = n_[a] < 0 ? -1 : 1;
    for (int k = 0; k < 3; ++k) {
      const double mb = -sign * side_[k][d];
      const double md = sign * side_[k][b];
      const double at = mb * corner_[k][b] + md * corner_[k][d];
      const double half_width = std::abs(mb) * half_[b] + std::abs(md) * half_[d];
      edges_[count_++] = {b, d, mb, md, at - half_width - error_[a]};
    }
  }

  double cell_[3], half_[3];
  double corner_[3][3], side_[3][3];
  double n_[3], error_[3], offset_, half_width_;
  int count_ = 0;
  Edge edges_[9];
};

}  // namespace grelha
