#include "frontend/scene/scene_builder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "frontend/scene/double3.hpp"

namespace grelha {
namespace {

Float3 unit(const Double3& a) {
  const double l = length(a);
  return {float(a[0] / l), float(a[1] / l), float(a[2] / l)};
}
bool is_none(const Float3& n) {
  return n == Float3{};
}

}  // namespace

Float3 valid_normal(const Float3& n) {
  constexpr double kLeast = 1e-30, kMost = 1e30;
  const Double3 d{n.x, n.y, n.z};
  const double squared = dot(d, d);
  if (squared >= kLeast && squared <= kMost)
    return n;
  if (!std::isfinite(squared) || squared == 0)
    return {};
  return unit(d);
}

void SceneBuilder::drop_flat(std::span<const Float3> corner_points) {
  ++file_.dropped.zero_area;
  for (const Float3& p : corner_points) {
    file_.dropped.flat.add(0, p.x);
    file_.dropped.flat.add(1, p.y);
    file_.dropped.flat.add(2, p.z);
  }
}

void SceneBuilder::drop_flat(std::initializer_list<Float3> corner_points) {
  drop_flat(std::span(corner_points.begin(), corner_points.size()));
}

void SceneBuilder::sphere(Float3 center, float radius, std::uint32_t material) {
  if (!is_finite_float(center) || !is_finite_float(radius))
    ++file_.dropped.not_finite;
  else if (radius == 0)
    drop_flat({center});
  else
    file_.scene.geometry.spheres.add(center, radius, material);
}

void SceneBuilder::cone(
    Float3 base, float base_radius, Float3 apex, float apex_radius, std::uint32_t material) {
  if (!is_finite_float(base) || !is_finite_float(apex) || !is_finite_float(base_radius) ||
      !is_finite_float(apex_radius))
    ++file_.dropped.not_finite;
  else if (base == apex || (base_radius == 0 && apex_radius == 0))
    drop_flat({base, apex});
  else
    file_.scene.geometry.cones.add(base, base_radius, apex, apex_radius, material);
}

void SceneBuilder::plane(Float3 a, Float3 b, Float3 c, std::uint32_t material) {
  if (!is_finite_float(a) || !is_finite_float(b) || !is_finite_float(c)) {
    ++file_.dropped.not_finite;
    return;
  }
  const Double3 normal = cross(difference(b, a), difference(c, a));
  if (is_zero(normal))
    drop_flat({a, b, c});
  else
    file_.scene.geometry.planes.add(a, unit(normal), material);
}

void SceneBuilder::plane(Float3 normal, float distance, std::uint32_t material) {
  const Double3 n{normal.x, normal.y, normal.z};
  const double squared = dot(n, n);
  if (!is_finite_float(normal) || !is_finite_float(distance)) {
    ++file_.dropped.not_finite;
    return;
  }
  if (squared == 0) {
    ++file_.dropped.zero_area;
    return;
  }
  const Float3 point{float(n[0] * distance / squared),
                     float(n[1] * distance / squared),
                     float(n[2] * distance / squared)};
  if (!is_finite_float(point))
    ++file_.dropped.not_finite;
  else
    file_.scene.geometry.planes.add(point, unit(n), material);
}

std::uint32_t SceneBuilder::add_vertex(Float3 point, Float3 normal, Float3 color) {
  Triangles& t = file_.scene.geometry.triangles;
  const std::size_t index = t.x.size();
  if (t.nx.empty() && !is_none(normal)) {
    t.nx.resize(index);
    t.ny.resize(index);
    t.nz.resize(index);
  }
  t.x.push_back(point.x);
  t.y.push_back(point.y);
  t.z.push_back(point.z);
  if (!t.nx.empty() || !is_none(normal)) {
    t.nx.push_back(normal.x);
    t.ny.push_back(normal.y);
    t.nz.push_back(normal.z);
  }
  if (!t.red.empty()) {
    t.red.push_back(color.x);
    t.green.push_back(color.y);
    t.blue.push_back(color.z);
  }
  return std::uint32_t(index);
}

void SceneBuilder::add_triangle(std::uint32_t a,
                                std::uint32_t b,
                                std::uint32_t c,
                                std::uint32_t material) {
  Triangles& t = file_.scene.geometry.triangles;
  t.a.push_back(a);
  t.b.push_back(b);
  t.c.push_back(c);
  t.material.push_back(material);
}

Float3 SceneBuilder::point(std::uint32_t vertex) const {
  const Triangles& t = file_.scene.geometry.triangles;
  return {t.x[vertex], t.y[vertex], t.z[vertex]};
}

bool SceneBuilder::has_area(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  const Float3 p = point(a);
  return !is_zero(cross(difference(point(b), p), difference(point(c), p)));
}

/// Returns true if the normal of a piece differs from the polygon's by more than a milliradian:
/// slivers of rounded corners do, and would shade as scratches.
bool SceneBuilder::is_nonplanar(std::span<const Float3> points) const {
  constexpr double kSine = 1e-3;
  const Double3& whole = splitter_.normal();
  const double whole_length = length(whole);
  return std::any_of(
      triangles_.begin(), triangles_.end(), [&](const PolygonSplitter::Triangle& part) {
        const Float3& o = points[part[0]];
        const Double3 normal =
            cross(difference(points[part[1]], o), difference(points[part[2]], o));
        return !(dot(normal, whole) > 0) ||
               length(cross(normal, whole)) > kSine * length(normal) * whole_length;
      });
}

/// Adds a polygon of three corners, the most frequent kind in most scenes.
void SceneBuilder::triangle(std::span<const Float3> corner_points,
                            std::span<const Float3> normals,
                            std::uint32_t material) {
  const Float3& o = corner_points[0];
  if (is_zero(cross(difference(corner_points[1], o), difference(corner_points[2], o))))
    return drop_flat(corner_points);
  const auto first = std::uint32_t(file_.scene.geometry.triangles.vertex_count());
  for (std::size_t i = 0; i < 3; ++i)
    add_vertex(corner_points[i], normals.empty() ? Float3{} : valid_normal(normals[i]));
  add_triangle(first, first + 1, first + 2, material);
}

/// Extends values of the corners by those at the intersections, if there are any.
void SceneBuilder::with_intersections(std::span<const Float3>& of_corners,
                                      std::vector<Float3>& all) {
  if (of_corners.empty() || splitter_.intersections().empty())
    return;
  all.assign(of_corners.begin(), of_corners.end());
  for (const SideCrossing& crossing : splitter_.intersections())
    all.push_back(at_crossing(of_corners, crossing));
  of_corners = all;
}

void SceneBuilder::polygon(std::span<const Float3> corner_points,
                           std::span<const Float3> normals,
                           std::uint32_t material,
                           const std::function<void(Result)>& report) {
  if (!std::all_of(corner_points.begin(), corner_points.end(), [](const Float3& p) {
        return is_finite_float(p);
      })) {
    ++file_.dropped.not_finite;
    return;
  }
  if (corner_points.size() == 3)
    return triangle(corner_points, normals, material);
  triangles_.clear();
  const Result result = splitter_.cut(corner_points, triangles_);
  if (report && result != Result::kCut && result != Result::kNoArea)
    report(result);
  if (result == Result::kNoArea)
    drop_flat(corner_points);
  if (triangles_.empty())
    return;
  with_intersections(corner_points, all_points_);
  with_intersections(normals, all_normals_);
  Float3 shared_normal;
  if (normals.empty() && is_nonplanar(corner_points))
    shared_normal = unit(splitter_.normal());
  const auto first = std::uint32_t(file_.scene.geometry.triangles.vertex_count());
  for (std::size_t i = 0; i < corner_points.size(); ++i)
    add_vertex(corner_points[i], normals.empty() ? shared_normal : valid_normal(normals[i]));
  for (const auto& [a, b, c] : triangles_)
    if (has_area(first + a, first + b, first + c))
      add_triangle(first + a, first + b, first + c, material);
}

void SceneBuilder::box(Float3 corner, Float3 opposite, std::uint32_t material) {
  if (!is_finite_float(corner) || !is_finite_float(opposite)) {
    ++file_.dropped.not_finite;
    return;
  }
  const Float3 lo{std::min(corner.x, opposite.x),
                  std::min(corner.y, opposite.y),
                  std::min(corner.z, opposite.z)};
  const Float3 hi{std::max(corner.x, opposite.x),
                  std::max(corner.y, opposite.y),
                  std::max(corner.z, opposite.z)};
  if (int(lo.x == hi.x) + int(lo.y == hi.y) + int(lo.z == hi.z) > 1)
    return drop_flat({lo, hi});
  const auto first = std::uint32_t(file_.scene.geometry.triangles.vertex_count());
  for (unsigned i = 0; i < 8; ++i)  // bit 0: x, bit 1: y, bit 2: z
    add_vertex({i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z}, {});
  static constexpr std::array<std::array<std::uint32_t, 4>, 6> kFaces{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& [a, b, c, d] : kFaces) {
    if (!has_area(first + a, first + b, first + c))
      continue;
    add_triangle(first + a, first + b, first + c, material);
    add_triangle(first + a, first + c, first + d, material);
  }
}

}  // namespace grelha
