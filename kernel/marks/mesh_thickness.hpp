#pragma once
// How thick a mesh is behind its triangles: what turns away from a point may be the outline of
// something thin, or of something large.

#include <cstdint>
#include <span>

#include "grelha/stats.hpp"
#include "kernel/render/setup.hpp"
#include "kernel/world/world_impl.hpp"

namespace grelha {

/// Asks by a ray from the middle of a triangle either way along its normal, as no mesh says which
/// way is in. Shapira, Shamir, Cohen-Or, "Consistent Mesh Partitioning and Skeletonisation Using
/// the Shape Diameter Function", 2008, send a cone of rays.
class MeshThickness {
 public:
  MeshThickness(const World::Impl& world, const Setup& setup) : world_(world), setup_(setup) {}

  /// Sets the way to the nearer of what lies on either side of triangles; 0 for triangles without
  /// an area. Where it is `enough` or more, that is all that it tells.
  void measure(std::span<const std::uint32_t> triangles,
               double enough,
               std::span<float> thickness,
               TraceCounts& counts) const;

 private:
  const World::Impl& world_;
  const Setup& setup_;
};

}  // namespace grelha
