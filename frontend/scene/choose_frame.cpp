#include "frontend/scene/choose_frame.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "frontend/scene/bounds.hpp"

namespace grelha {
namespace {

/// Largest distance from the origin to a scene's middle, in sizes of the scene: floats then resolve
/// a millionth of the size.
constexpr double kMaxRatio = 4;
/// Squares of lengths from here on are normal floats, with room for further products.
constexpr double kSmallest = 0x1p-40;

struct Cube {
  std::array<double, 3> middle;
  double size;  ///< of the largest side
};

Cube cube_around(const SceneBounds& bounds) {
  const float low[3] = {bounds.low.x, bounds.low.y, bounds.low.z};
  const float high[3] = {bounds.high.x, bounds.high.y, bounds.high.z};
  Cube cube{{}, 0};
  for (std::size_t a = 0; a < 3; ++a) {
    cube.middle[a] = .5 * (double{low[a]} + high[a]);
    cube.size = std::max(cube.size, double{high[a]} - low[a]);
  }
  return cube;
}

double largest(const std::array<double, 3>& v) {
  return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
}

/// The least power of two that is not below.
double power_of_two(double least) {
  return std::ldexp(1, std::ilogb(least) + 1);
}

std::array<double, 3> offset_of(const Cube& cube) {
  // no finer than floats are there, if the size vanishes
  const double step = power_of_two(std::max(cube.size, 0x1p-22 * largest(cube.middle)));
  std::array<double, 3> offset;
  for (std::size_t a = 0; a < 3; ++a)
    offset[a] = step * std::nearbyint(cube.middle[a] / step);
  return offset;
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

/// Returns the largest coordinate of primitives, camera and lights.
double extent_of(const SceneFile& file) {
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
  const double extent = extent_of(file);
  if (extent > 0 && extent < kSmallest)
    return Frame{{}, 1 / power_of_two(extent)};
  if (bounds.empty)
    return {};
  const Cube cube = cube_around(bounds);
  if (!std::isfinite(cube.size) || !(largest(cube.middle) > kMaxRatio * cube.size))
    return {};
  return Frame{offset_of(cube), 1};
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
