#include "grelha/owning_world.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/world/used_points.hpp"
#include "kernel/world/world_impl.hpp"

namespace grelha {
namespace {

struct Place {
  const char* rows;
  std::size_t row;
  std::optional<std::size_t> column{};
};

[[noreturn]] void refuse(const std::string& expected, const std::string& found, Place at) {
  BadNumber bad(expected + ", found " + found + " in " + at.rows + ' ' + std::to_string(at.row));
  bad.found = found;
  bad.row = at.row;
  bad.column = at.column;
  throw bad;
}

void expect_one_kind(const Geometry& shapes, std::size_t points) {
  const std::size_t spheres = shapes.spheres.size();
  if (!shapes.planes.x.empty() || !shapes.cones.base_x.empty() ||
      (spheres > 0 && !shapes.triangles.a.empty()))
    throw std::invalid_argument("scene: expected triangles alone, or spheres alone");
  if (spheres > 0 && spheres != points)
    throw std::invalid_argument("points: expected one for each sphere");
}

/// The box of the points that shapes use, all of which must be usable.
PointBounds checked_bounds(const PointArray& points, const Geometry& shapes) {
  expect_one_kind(shapes, points.count);
  PointBounds bounds;
  each_used(shapes, points.count, [&](std::size_t i) {
    for (std::size_t a = 0; a < 3; ++a) {
      const double value = points.at(i, a);
      if (!(std::abs(value) <= kLargestLength))
        refuse(points.name + std::string(": expected finite numbers within 1e18"),
               std::to_string(value),
               {"element", i, a});
      bounds.add(a, value);
    }
  });
  return bounds;
}

using Axes = std::array<std::vector<float>, 3>;

Axes less(const PointArray& points, const std::array<double, 3>& offset) {
  Axes axes;
  for (std::size_t a = 0; a < 3; ++a) {
    axes[a].resize(points.count);
    for (std::size_t i = 0; i < points.count; ++i)
      axes[a][i] = static_cast<float>(points.at(i, a) - offset[a]);
  }
  return axes;
}

/// Swaps the points of shapes of one kind.
void swap_points(Geometry& shapes, Axes& points) {
  const auto swap = [&](auto& s) {
    s.x.swap(points[0]);
    s.y.swap(points[1]);
    s.z.swap(points[2]);
  };
  if (shapes.spheres.size() > 0)
    swap(shapes.spheres);
  else
    swap(shapes.triangles);
}

}  // namespace

template <class Index>
Geometry triangles_of(std::span<const std::array<Index, 3>> faces, std::size_t vertices) {
  Geometry made;
  Triangles& t = made.triangles;
  std::vector<std::uint32_t>* const corners[3] = {&t.a, &t.b, &t.c};
  for (std::vector<std::uint32_t>* const corner : corners)
    corner->resize(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index vertex = faces[i][k];
      if (static_cast<std::uint64_t>(vertex) >= vertices)  // negative ones are large
        refuse("indices: expected numbers below " + std::to_string(vertices),
               std::to_string(vertex),
               {"triangle", i, k});
      (*corners[k])[i] = static_cast<std::uint32_t>(vertex);
    }
  return made;
}
template Geometry triangles_of(std::span<const std::array<std::uint32_t, 3>>, std::size_t);
template Geometry triangles_of(std::span<const std::array<std::int64_t, 3>>, std::size_t);

template <class Number>
Geometry spheres_of(std::span<const Number> radii) {
  Geometry made;
  made.spheres.radius.assign(radii.begin(), radii.end());
  for (std::size_t i = 0; i < radii.size(); ++i)
    if (!(made.spheres.radius[i] > 0 && double{radii[i]} <= kLargestLength))
      refuse("radii: expected numbers above 0 and within 1e18",
             std::to_string(radii[i]),
             {"element", i});
  return made;
}
template Geometry spheres_of(std::span<const float>);
template Geometry spheres_of(std::span<const double>);

std::vector<double> doubles_of(const PointArray& points) {
  std::vector<double> all(3 * points.count);
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = points.at(i / 3, i % 3);
  return all;
}

OffsetScene scene_of(const PointArray& points, Geometry shapes) {
  const PointBounds bounds = checked_bounds(points, shapes);
  OffsetScene scene;
  scene.geometry = std::move(shapes);
  if (points.in_double)  // floats stay as the caller has them, and so do rays and points
    scene.offset = bounds.offset();
  Axes axes = less(points, scene.offset);
  swap_points(scene.geometry, axes);
  return scene;
}

void OwningWorld::move(const PointArray& points, const BuildOptions& options) {
  Geometry& g = scene_.geometry;
  const std::size_t count = std::max(g.spheres.x.size(), g.triangles.x.size());
  if (points.count != count)
    throw std::invalid_argument("count: expected as many points as before, " +
                                std::to_string(count) + ", found " + std::to_string(points.count));
  const PointBounds bounds = checked_bounds(points, g);
  const bool in_double = points.in_double;
  const auto offset = in_double ? bounds.offset(scene_.offset) : std::array<double, 3>{};
  std::vector<double> doubles;
  if (in_double && !scene_.first_vertices.empty())
    doubles = doubles_of(points);
  Axes axes = less(points, offset);
  swap_points(g, axes);
  try {
    world_.update(scene_, options);
  } catch (...) {
    swap_points(g, axes);  // which the World still refers to
    throw;
  }
  scene_.doubles = std::move(doubles);
  if (in_double)
    scene_.offset = offset;
}

void OwningWorld::replace(OffsetScene scene,
                          const BuildOptions& options,
                          std::span<const Object> moved) {
  OwningWorld next(std::move(scene), options, *this, moved);
  if (!masks_.empty()) {
    next.masks_ = masks_;
    next.masks_.resize(next.world_.impl().primitives.ids.end(), 255);
  }
  *this = std::move(next);
}

void OwningWorld::set_masks(std::span<const std::uint8_t> masks) {
  const std::size_t all = world_.impl().primitives.ids.end();
  if (!masks.empty() && masks.size() != all)
    throw std::invalid_argument("count: expected 0 or " + std::to_string(all) + ", found " +
                                std::to_string(masks.size()));
  masks_.assign(masks.begin(), masks.end());
}

}  // namespace grelha
