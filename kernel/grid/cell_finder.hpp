#pragma once
// Which cells of a grid a primitive touches.

#include <algorithm>
#include <cmath>

#include "kernel/grid/grid.hpp"

namespace grelha {

/// A cell grown by pad against a triangle: the plane, and each edge seen along the axes across
/// which the triangle spans several cells. Together with boxes that meet these are all the
/// separating axes, so what is left is touched.
class TriangleTouch {
 public:
  TriangleTouch(
      const Corners& c, const Grid& g, double pad, const int (&lo)[3], const int (&hi)[3]) {
    double v[3][3], e[3][3], half[3];
    for (int a = 0; a < 3; ++a) {
      cell_[a] = g.cell[a];
      half[a] = g.cell[a] / 2 + pad;
      for (int k = 0; k < 3; ++k)
        v[k][a] = c.v[k][a] - g.lo[a];
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
      if (lo[b] == hi[b] || lo[d] == hi[d])
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

/// A cell grown by pad against a ball's surface: nearest point inside, farthest outside.
class SphereTouch {
 public:
  SphereTouch(const Primitives& p, std::uint32_t id, const Grid& g, double pad) {
    const SphereSpans& s = p.geometry.spheres;
    const std::uint32_t i = id - p.sphere_base;
    const double center[3] = {s.x[i], s.y[i], s.z[i]},
                 radius = std::abs(static_cast<double>(s.radius[i]));
    for (int a = 0; a < 3; ++a) {
      cell_[a] = g.cell[a];
      center_[a] = center[a] - g.lo[a];
    }
    const double r = radius + pad, inner = radius - pad;
    reach_ = r * r * (1 + 1e-12);
    inner_ = inner > 0 ? inner * inner * (1 - 1e-12) : -1;
  }
  bool operator()(const int (&at)[3]) const {
    double near = 0, far = 0;
    for (int a = 0; a < 3; ++a) {
      const double lo = at[a] * cell_[a] - center_[a], hi = (at[a] + 1) * cell_[a] - center_[a];
      const double least = lo > 0   ? lo
                           : hi < 0 ? -hi
                                    : 0,
                   most = std::max(std::abs(lo), std::abs(hi));
      near += least * least;
      far += most * most;
    }
    return near <= reach_ && far >= inner_;
  }

 private:
  double cell_[3], center_[3], reach_, inner_;
};

/// Calls visit(cell) for every cell a primitive is to stand in, ascending.
class CellFinder {
 public:
  CellFinder(const Primitives& p, const Grid& g, double pad) : p_(p), g_(g), pad_(pad) {
    for (int a = 0; a < 3; ++a)
      inv_[a] = 1 / g.cell[a];
  }
  template <class Visit>
  void operator()(std::uint32_t id, const Visit& visit) const {
    const Kind kind = kind_of(p_, id);
    Corners corners;
    Box b;
    if (kind == Kind::kTriangle) {
      corners = corners_of(p_, id);
      b = box_of(corners);
    } else {
      b = p_.box(id);
    }
    int lo[3], hi[3];
    bool several = false;
    for (int a = 0; a < 3; ++a) {
      const int n = static_cast<int>(g_.cells[static_cast<std::size_t>(a)]);
      lo[a] = cell_of(b.lo[a] - pad_, g_.lo[a], inv_[a], n);
      hi[a] = cell_of(b.hi[a] + pad_, g_.lo[a], inv_[a], n);
      several |= hi[a] > lo[a];
    }
    if (!several || kind == Kind::kCone)
      return all(lo, hi, visit, [](const int(&)[3]) { return true; });
    if (kind == Kind::kSphere)
      return all(lo, hi, visit, SphereTouch(p_, id, g_, pad_));
    all(lo, hi, visit, TriangleTouch(corners, g_, pad_, lo, hi));
  }

 private:
  template <class Visit, class Touch>
  void all(const int (&lo)[3], const int (&hi)[3], const Visit& visit, const Touch& touch) const {
    const std::size_t nx = g_.cells[0], nxy = nx * g_.cells[1];
    for (int z = lo[2]; z <= hi[2]; ++z)
      for (int y = lo[1]; y <= hi[1]; ++y)
        for (int x = lo[0]; x <= hi[0]; ++x)
          if (touch({x, y, z}))
            visit(static_cast<std::size_t>(x) + nx * static_cast<std::size_t>(y) +
                  nxy * static_cast<std::size_t>(z));
  }
  const Primitives& p_;
  const Grid& g_;
  double pad_, inv_[3];
};

}  // namespace grelha
