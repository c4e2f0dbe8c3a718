#pragma once

#include <vector>

#include "kernel/picture/rod.hpp"
#include "kernel/grid/world_impl.hpp"

namespace grelha {

/// The plane of points p with dot(normal, p) = distance.
struct MirrorPlane {
  Point3 normal;  ///< a unit vector
  double distance;

  double above(const Point3& p) const { return dot(normal, p) - distance; }
  /// The mirror image of a point.
  Point3 image(const Point3& p) const {
    const double twice = 2 * above(p);
    return {{p[0] - twice * normal[0], p[1] - twice * normal[1], p[2] - twice * normal[2]}};
  }
};

/// Planes of smooth mirrors, each once; empty if there are more than a few, as in a curved mirror.
std::vector<MirrorPlane> flat_mirrors(const World::Impl& world);

/// True if a material is a smooth mirror.
bool is_smooth_mirror(const MaterialView& materials, std::uint32_t material);

}  // namespace grelha
