#pragma once
// The steps of a render between a hit and the next ray, by the scalar copy of the kernel.
#define GRELHA_ISA scalar
#include "kernel/shapes/surface.hpp"
#include "kernel/traverse/trace.hpp"

#include "tests/support/oracle.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {

using V = scalar::Vec3<float>;
using Surface = scalar::Surface<float>;

inline V vec(const Float3& p) {
  return {p.x, p.y, p.z};
}
inline Float3 floats(const V& p) {
  return {p.x, p.y, p.z};
}

/// Closest hits of single rays.
inline Answers scalar_hits(const World& world, const RayList& rays) {
  return trace(*find_variant("scalar"), world, rays, {1, true}, Query::kClosest);
}

/// The surface that a ray hits at t.
inline Surface surface_at(
    const World& world, std::uint32_t id, const Float3& org, const Float3& dir, float t) {
  return scalar::surface_of<float>(world.impl().view.geometry, id, vec(org), vec(dir), t, false);
}

/// Returns the origin of a ray that leaves the surface in direction `dir`.
inline Float3 start_of(const Surface& s, const Float3& dir) {
  return floats(scalar::offset_origin(s.point, s.normal, s.offset, vec(dir)));
}

}  // namespace grelha::test
