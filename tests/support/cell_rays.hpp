#pragma once
// Rays where a walk through a grid can go wrong.

#include "tests/support/ray_list.hpp"

namespace grelha::test {

/// Rays that lie in planes between cells, run along edges between them, pass through their corners,
/// or along their diagonals.
inline RayList rays_on_cells(Random& random, const World& world, int count) {
  RayList rays;
  const auto& grids = world.impl().grids;
  if (grids.empty())
    return rays;
  for (int i = 0; i < count; ++i) {
    const Grid& g = grids[random.below(static_cast<std::uint32_t>(grids.size()))];
    const auto corner = [&] {
      Float3 p;
      for (std::uint32_t a = 0; a < 3; ++a)
        component(p, a) = static_cast<float>(g.lo[a] + random.below(g.cells[a] + 1) * g.cell[a]);
      return p;
    };
    const Float3 from = corner(), to = corner();
    Float3 org = from, dir = minus(to, from);
    switch (random.below(4)) {
      case 0: {  // in a plane
        const std::uint32_t a = random.below(3);
        for (std::uint32_t b = 0; b < 3; ++b)
          component(dir, b) =
              b == a ? random.zero() : static_cast<float>(random.in(-1, 1) * g.cell[b]);
        org = at(from, -random.in(0, 20), dir);
        component(org, a) = a == 0 ? from.x : a == 1 ? from.y : from.z;
        break;
      }
      case 1: {  // along an edge
        const std::uint32_t a = random.below(3);
        const float length = static_cast<float>(random.sign() * g.cell[a]);
        for (std::uint32_t b = 0; b < 3; ++b)
          component(dir, b) = b == a ? length : random.zero();
        org = at(from, -random.in(0, 20), dir);
        break;
      }
      case 2:  // down the diagonals of cells
        for (std::uint32_t b = 0; b < 3; ++b)
          component(dir, b) = static_cast<float>(random.sign() * g.cell[b]);
        org = at(from, -double(random.below(20)), dir);
        break;
      default:
        break;  // from corner to corner
    }
    if (dir == Float3{})
      continue;
    rays.add(org,
             random.chance(.3) ? scaled(dir, random.log_in(1e-3, 1e3)) : dir,
             random.chance(.5) ? 0 : -kInf);
  }
  return rays;
}

}  // namespace grelha::test
