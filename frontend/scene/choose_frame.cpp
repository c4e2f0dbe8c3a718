#include "frontend/scene/choose_frame.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "frontend/scene/bounds.hpp"
#include "grelha/coordinates.hpp"

namespace grelha {
namespace {

/// Squares of lengths from here on are normal floats, with room for further products.
constexpr double kSmallest = 0x1p-40;

double largest(const std::array<double, 3>& v) {
  return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
}

/// The least power of two that is not below.
double power_of_two(double least) {
  return std::ldexp(1, std::ilogb(least) + 1);
}

/// Calls visit(coordinates of one axis, axis) for every position in a scene but the camera's.
template <class Visit>
void for_each_position(const Geometry& g, const Visit& visit) {
  const std::span<const float> coordinates[][3] = {
      {g.spheres.x, g.spheres.y, g.spheres.z},
      {g.triangles.x, g.triangles.y, g.triangles.z},
      {g.cones.base_x, g.cones.base_y, g.cones.base_z},
      {g.cones.apex_x, g.cones.apex_y, g.cones.apex_z},
      {g.planes.x, g.planes.y, g.planes.z},
  };
  for (const auto& axes : coordinates)
    for (std::size_t a = 0; a < 3; ++a)
      visit(axes[a], a);
}

PointBounds around(const SceneBounds& bounds) {
  PointBounds box;
  for (const Float3& p : {bounds.low, bounds.high}) {
    box.add(0, p.x);
    box.add(1, p.y);
    box.add(2, p.z);
  }
  return box;
}

/// Returns the largest coordinate of primitives, camera and lights.
double largest_coordinate(const SceneFile& file) {
  double most = 0;
  const auto add = [&](const Float3& p) { most = std::max(most, largest({p.x, p.y, p.z})); };
  for_each_position(file.scene.geometry, [&](std::span<const float> coordinates, std::size_t) {
    for (const float c : coordinates)
      most = std::max(most, std::abs(double{c}));
  });
  if (!file.default_camera)
    for (const Float3& p : {file.camera.eye, file.camera.at})
      add(p);
  for (const Light& light : file.scene.lights)
    if (!file.default_light)
      add(light.position);
  return most;
}

}  // namespace

std::optional<Frame> find_frame(const SceneFile& file) {
  const SceneBounds bounds = bounds_of(file.scene.geometry);
  const double most = largest_coordinate(file);
  if (most > 0 && most < kSmallest)
    return Frame{{}, 1 / power_of_two(most)};
  const std::array<double, 3> offset =
      bounds.empty ? file.dropped.flat.offset() : around(bounds).offset();
  if (largest(offset) == 0)
    return {};
  return Frame{offset, 1};
}

bool needs_frame(const SceneFile& file) {
  const Frame& frame = file.frame;
  bool needed = frame.scale != 1;
  for_each_position(file.scene.geometry, [&](std::span<const float> coordinates, std::size_t a) {
    needed = needed || std::ranges::any_of(coordinates, [&](float c) {
               const double outside = frame.outside(c, a);
               return double{static_cast<float>(outside)} != outside;
             });
  });
  return needed;
}

}  // namespace grelha
