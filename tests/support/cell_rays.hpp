#pragma once
// Rays where a walk through a grid can go wrong.

#include "tests/support/ray_list.hpp"

namespace grelha::test {

struct Line {
  Float3 org, dir;
};

inline Float3 corner_of(Random& random, const Grid& g) {
  Float3 p;
  for (std::uint32_t a = 0; a < 3; ++a)
    component(p, a) = static_cast<float>(g.lo[a] + random.below(g.cells[a] + 1) * g.cell[a]);
  return p;
}

/// A ray in one of the planes between cells that meet in the corner.
inline Line in_a_plane(Random& random, const Grid& g, const Float3& corner) {
  const std::uint32_t a = random.below(3);
  Float3 dir;
  for (std::uint32_t b = 0; b < 3; ++b)
    component(dir, b) = b == a ? random.zero() : static_cast<float>(random.in(-1, 1) * g.cell[b]);
  Float3 org = at(corner, -random.in(0, 20), dir);
  Float3 same = corner;
  component(org, a) = component(same, a);
  return {org, dir};
}

inline Line along_an_edge(Random& random, const Grid& g, const Float3& corner) {
  const std::uint32_t a = random.below(3);
  const float length = static_cast<float>(random.sign() * g.cell[a]);
  Float3 dir;
  for (std::uint32_t b = 0; b < 3; ++b)
    component(dir, b) = b == a ? length : random.zero();
  return {at(corner, -random.in(0, 20), dir), dir};
}

inline Line down_diagonals(Random& random, const Grid& g, const Float3& corner) {
  Float3 dir;
  for (std::uint32_t b = 0; b < 3; ++b)
    component(dir, b) = static_cast<float>(random.sign() * g.cell[b]);
  return {at(corner, -double(random.below(20)), dir), dir};
}

inline Line line_on_cells(Random& random, const Grid& g) {
  const Float3 from = corner_of(random, g), to = corner_of(random, g);
  switch (random.below(4)) {
    case 0:
      return in_a_plane(random, g, from);
    case 1:
      return along_an_edge(random, g, from);
    case 2:
      return down_diagonals(random, g, from);
    default:
      return {from, minus(to, from)};
  }
}

/// Rays that lie in planes between cells, run along edges between them, pass through their corners,
/// or along their diagonals.
inline RayList rays_on_cells(Random& random, const World& world, int count) {
  RayList rays;
  const auto& grids = world.impl().grids;
  if (grids.empty())
    return rays;
  for (int i = 0; i < count; ++i) {
    const Grid& g = grids[random.below(static_cast<std::uint32_t>(grids.size()))]->grid;
    const Line line = line_on_cells(random, g);
    if (line.dir == Float3{})
      continue;
    rays.add(line.org,
             random.chance(.3) ? scaled(line.dir, random.log_in(1e-3, 1e3)) : line.dir,
             random.chance(.5) ? 0 : -kInf);
  }
  return rays;
}

}  // namespace grelha::test
