#include "frontend/scene/scene_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>

#include "grelha/coordinates.hpp"

namespace grelha {

std::string text_of(const Frame& frame) {
  const auto number = [](double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", x);
    return std::string(text);
  };
  std::string text = "counted from " + number(frame.offset[0]) + ' ' + number(frame.offset[1]) +
                     ' ' + number(frame.offset[2]);
  if (frame.scale != 1)
    text += ", enlarged 2^" + std::to_string(std::ilogb(frame.scale)) + " times";
  return text;
}

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

namespace {

class Box {
 public:
  void grow(Float3 center, Float3 extent) {
    grow_axis(center.x, extent.x, bounds_.low.x, bounds_.high.x);
    grow_axis(center.y, extent.y, bounds_.low.y, bounds_.high.y);
    grow_axis(center.z, extent.z, bounds_.low.z, bounds_.high.z);
    bounds_.empty = false;
  }
  const SceneBounds& bounds() const { return bounds_; }

 private:
  void grow_axis(float center, float extent, float& low, float& high) const {
    low = bounds_.empty ? center - extent : std::min(low, center - extent);
    high = bounds_.empty ? center + extent : std::max(high, center + extent);
  }

  SceneBounds bounds_;
};

/// Returns the extent of a disc of that radius along each axis; `x y z` is its normal, of any
/// length.
Float3 disk_extent(double radius, double x, double y, double z) {
  const double square = x * x + y * y + z * z;
  const auto extent = [&](double c) {
    return float(std::abs(radius) * std::sqrt(std::max(0.0, 1 - c * c / square)));
  };
  return {extent(x), extent(y), extent(z)};
}

void grow(Box& box, const Spheres& s, std::size_t i) {
  const float r = std::abs(s.radius[i]);
  box.grow({s.x[i], s.y[i], s.z[i]}, {r, r, r});
}

void grow(Box& box, const Cones& c, std::size_t i) {
  const double x = double(c.apex_x[i]) - c.base_x[i], y = double(c.apex_y[i]) - c.base_y[i];
  const double z = double(c.apex_z[i]) - c.base_z[i];
  box.grow({c.base_x[i], c.base_y[i], c.base_z[i]}, disk_extent(c.base_radius[i], x, y, z));
  box.grow({c.apex_x[i], c.apex_y[i], c.apex_z[i]}, disk_extent(c.apex_radius[i], x, y, z));
}

/// Grows the box by one triangle: its mesh may hold unused vertices.
void grow(Box& box, const Triangles& t, std::size_t i) {
  for (const std::uint32_t vertex : {t.a[i], t.b[i], t.c[i]})
    box.grow({t.x[vertex], t.y[vertex], t.z[vertex]}, {});
}

}  // namespace

SceneBounds bounds_of(const Geometry& geometry) {
  Box box;
  for (std::size_t i = 0; i < geometry.spheres.size(); ++i)
    grow(box, geometry.spheres, i);
  for (std::size_t i = 0; i < geometry.cones.size(); ++i)
    grow(box, geometry.cones, i);
  for (std::size_t i = 0; i < geometry.triangles.size(); ++i)
    grow(box, geometry.triangles, i);
  return box.bounds();
}

}  // namespace grelha
