#pragma once
// Scenes that tests of grids are tried on, and points that lie in what a grid holds.

#include "kernel/grid/grid.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

#include <algorithm>

namespace grelha::test {

/// Ids in one cell, in the order they stand there; those of triangles, which stand as their blocks
/// want it, ascending.
inline std::vector<std::uint32_t> ids_of(const CellStore& s, std::size_t cell) {
  std::vector<std::uint32_t> out;
  for_each_finite_shape([&]<class Shape>() {
    const auto& list = s.of<Shape>();
    if (list.first.empty())
      return;
    if constexpr (Shape::kInBlocks) {
      const auto others = static_cast<std::ptrdiff_t>(out.size());
      const auto [first, end] = list.list().blocks_of(cell);
      for (std::uint32_t b = first; b < end; ++b)
        for (const std::uint32_t id : list.blocks[b].id)
          if (id != kNoPrimitive)
            out.push_back(id);
      std::sort(out.begin() + others, out.end());
    } else {
      out.insert(out.end(), &list.id[list.first[cell]], &list.id[list.first[cell + 1]]);
    }
  });
  return out;
}

struct Point {
  double x[3];
};
inline Point mixed(const Float3& p, double s, const Float3& d, double t = 0, const Float3& e = {}) {
  return {{p.x + s * d.x + t * e.x, p.y + s * d.y + t * e.y, p.z + s * d.z + t * e.z}};
}
inline double dot(const Point& a, const Point& b) {
  return a.x[0] * b.x[0] + a.x[1] * b.x[1] + a.x[2] * b.x[2];
}

/// Points on the surface of a primitive, corners and edges among them, in double: far from 0 a
/// float would lie beside it.
inline std::vector<Point> surface_points(
    const Scene& s, const Primitives& p, std::uint32_t id, Random& random, int count) {
  std::vector<Point> out;
  const Geometry& g = s.geometry;
  for (int i = 0; i < count; ++i) {
    const auto [kind, k] = p.ids.primitive(id);
    if (kind == PrimitiveKind::kSphere) {
      Float3 d = random.direction();
      if (i < 6) {
        d = {};
        component(d, i % 3u) = i < 3 ? 1.f : -1.f;
      }
      const Point unit = mixed({}, 1, d);
      out.push_back(mixed({g.spheres.x[k], g.spheres.y[k], g.spheres.z[k]},
                          std::abs(double{g.spheres.radius[k]}) / std::sqrt(dot(unit, unit)),
                          d));
    } else if (kind == PrimitiveKind::kTriangle) {
      const Float3 a = vertex(s, g.triangles.a[k]), b = vertex(s, g.triangles.b[k]),
                   c = vertex(s, g.triangles.c[k]);
      const double u = i < 8 ? i % 2 : random.unit(),
                   v = (1 - u) * (i < 8 ? i / 2 % 2 : random.unit());
      Point q;
      for (std::uint32_t k2 = 0; k2 < 3; ++k2) {
        Float3 corner[3] = {a, b, c};
        const double x[3] = {
            component(corner[0], k2), component(corner[1], k2), component(corner[2], k2)};
        q.x[k2] = x[0] + u * (x[1] - x[0]) + v * (x[2] - x[0]);
      }
      out.push_back(q);
    } else {
      const Cones& c = g.cones;
      const double base[3] = {c.base_x[k], c.base_y[k], c.base_z[k]};
      const Point axis{{c.apex_x[k] - base[0], c.apex_y[k] - base[1], c.apex_z[k] - base[2]}};
      const double h = i < 8 ? i % 2 : random.unit();
      const double r = std::abs(c.base_radius[k]) * (1 - h) + std::abs(c.apex_radius[k]) * h;
      for (;;) {
        const Point d = mixed({}, 1, random.direction());
        const double along = dot(d, axis) / dot(axis, axis);
        Point across;
        for (int a = 0; a < 3; ++a)
          across.x[a] = d.x[a] - along * axis.x[a];
        const double l = std::sqrt(dot(across, across));
        if (l < .1)
          continue;
        Point q;
        for (int a = 0; a < 3; ++a)
          q.x[a] = base[a] + h * axis.x[a] + r / l * across.x[a];
        out.push_back(q);
        break;
      }
    }
  }
  return out;
}

struct Case {
  const char* name;
  Scene scene;
};

inline std::vector<Case> cases() {
  const Float3 far{148376, 1234, -223423};
  return {{"spheres", random_spheres(3, 300)},
          {"triangles", random_triangles(3, 300)},
          {"cones", random_cones(3, 200)},
          {"mixture", random_mixture(3, 300)},
          {"flat", flat_sheet(3, 200)},
          {"needles", needles(3, 90)},
          {"heap", heap(3, 20)},
          {"stadium", stadium(3, 300)},
          {"wide plain", crowd_on_a_wide_plain(3, 300)},
          {"lattice", lattice_patch(9)},
          {"sheets", stacked_sheets(300)},
          {"towns", towns_in_a_desert(3, 3000)},
          {"tiny", placed(random_mixture(3, 300), 1e-6, {})},
          {"far", placed(random_mixture(3, 300), 2, far)}};
}

}  // namespace grelha::test
