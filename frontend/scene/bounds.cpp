#include "frontend/scene/bounds.hpp"

#include <algorithm>
#include <cmath>

namespace grelha {
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
