#include "kernel/picture/target_rays.hpp"

#include <algorithm>

namespace grelha {
namespace {

constexpr std::size_t kMostPlanes = 6;  ///< of a box of mirrors; each costs a search
constexpr double kSame = 1e-4;          ///< between planes: float corners of one polygon

/// Adds a plane that is not there yet. False: there are too many.
bool add(std::vector<MirrorPlane>& planes, const Point3& point, const Point3& normal) {
  const double length = std::sqrt(dot(normal, normal));
  if (!(length > 0))
    return true;
  MirrorPlane plane{{{normal[0] / length, normal[1] / length, normal[2] / length}}, 0};
  plane.distance = dot(plane.normal, point);
  const double far = 1 + std::abs(plane.distance);
  const auto is_same = [&](const MirrorPlane& other) {
    const double turn = dot(plane.normal, other.normal);
    const double sign = turn < 0 ? -1 : 1;
    return sign * turn > 1 - kSame * kSame &&
           std::abs(plane.distance - sign * other.distance) <= kSame * far;
  };
  if (std::any_of(planes.begin(), planes.end(), is_same))
    return true;
  planes.push_back(plane);
  return planes.size() <= kMostPlanes;
}

}  // namespace

bool is_smooth_mirror(const MaterialView& materials, std::uint32_t m) {
  return std::max({materials.field[kMirrorR][m],
                   materials.field[kMirrorG][m],
                   materials.field[kMirrorB][m]}) > 0 &&
         materials.field[kRoughness][m] == 0;
}

std::vector<MirrorPlane> flat_mirrors(const World::Impl& world) {
  std::vector<MirrorPlane> planes;
  if (!world.shading.reflects)
    return planes;
  const MaterialView& materials = world.shading.materials;
  const PlaneSpans& p = world.primitives.geometry.planes;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (is_smooth_mirror(materials, p.material[i]) &&
        !add(planes, {{p.x[i], p.y[i], p.z[i]}}, {{p.nx[i], p.ny[i], p.nz[i]}}))
      return {};
  const TriangleSpans& t = world.primitives.geometry.triangles;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (!is_smooth_mirror(materials, t.material[i]))
      continue;
    const Point3 a = corner_of(t, t.a[i]);
    if (!add(planes, a, cross(corner_of(t, t.b[i]) - a, corner_of(t, t.c[i]) - a)))
      return {};
  }
  return planes;
}

}  // namespace grelha
