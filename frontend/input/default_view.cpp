#include "frontend/input/default_view.hpp"

#include "frontend/input/view.hpp"
#include "frontend/scene/double3.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace grelha {
namespace {

using Point3 = Double3;

Point3 moved(const Point3& a, double share, const Point3& b) {
  return {a[0] + share * b[0], a[1] + share * b[1], a[2] + share * b[2]};
}

bool has_area(const Triangles& t, std::size_t i) {
  const auto point = [&](std::uint32_t v) { return Float3{t.x[v], t.y[v], t.z[v]}; };
  const Float3 a = point(t.a[i]);
  return !is_zero(cross(difference(point(t.b[i]), a), difference(point(t.c[i]), a)));
}

/// Returns the vertices of triangles that are seen, for others may lie anywhere, and the centres of
/// balls.
std::vector<Point3> points_of(const Geometry& g) {
  const Triangles& t = g.triangles;
  std::vector<std::uint8_t> named(t.vertex_count());
  for (std::size_t i = 0; i < t.size(); ++i)
    if (has_area(t, i))
      for (const auto* of : {&t.a, &t.b, &t.c})
        named[(*of)[i]] = 1;
  std::vector<Point3> found;
  found.reserve(t.vertex_count());
  for (std::size_t v = 0; v < t.vertex_count(); ++v)
    if (named[v])
      found.push_back({t.x[v], t.y[v], t.z[v]});
  for (std::size_t i = 0; i < g.spheres.size(); ++i)
    found.push_back({g.spheres.x[i], g.spheres.y[i], g.spheres.z[i]});
  if (found.empty())
    found = {{-1, -1, -1}, {1, 1, 1}};
  return found;
}

double max_distance(const std::vector<Point3>& points) {
  double most = 0;
  for (const Point3& p : points)
    for (const double c : p)
      most = std::max(most, std::abs(c));
  return most;
}

struct Extents {
  explicit Extents(const std::vector<Point3>& points) : low(points[0]), high(points[0]) {
    for (const Point3& p : points)
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], p[i]);
        high[i] = std::max(high[i], p[i]);
      }
  }
  Point3 low, high;
};

/// The middle of a box around points, and the radius of a ball about it.
MeshExtent extent_of(const std::vector<Point3>& points) {
  const Extents box(points);
  MeshExtent extent;
  extent.center = in_floats(moved(box.low, .5, moved(box.high, -1, box.low)));
  for (const Point3& p : points)
    extent.radius = std::max(extent.radius, length(moved(p, -1, in_double(extent.center))));
  return extent;
}

/// The share of the box's cross-section that the lowest points along an axis span: a mesh stands on
/// a wide base.
double support(const std::vector<Point3>& points, std::size_t axis) {
  constexpr double kLowest = .02;  // of the height
  const auto [low, high] = Extents(points);
  Point3 from = high, to = low;
  for (const Point3& p : points)
    if (p[axis] <= low[axis] + kLowest * (high[axis] - low[axis]))
      for (std::size_t i = 0; i < 3; ++i) {
        from[i] = std::min(from[i], p[i]);
        to[i] = std::max(to[i], p[i]);
      }
  double share = 1;
  for (std::size_t i = 0; i < 3; ++i)
    if (i != axis && high[i] > low[i])
      share *= (to[i] - from[i]) / (high[i] - low[i]);
  return share;
}

/// Scans have y up, most other meshes z. Returns true if the mesh stands on its z side far more
/// surely.
bool is_on_z(const std::vector<Point3>& points) {
  constexpr double kSurely = 4, kLeast = .1;
  const double z = support(points, 2);
  return z > kLeast && z > kSurely * support(points, 1);
}

/// The eye looks from 30 degrees to the right and 20 above. Sines and cosines are written down, for
/// the library's last bit depends on the machine.
constexpr double kSin30 = 0.5, kCos30 = 0.8660254037844386, kSin20 = 0.3420201433256687,
                 kCos20 = 0.9396926207859084;
struct Axes {
  Point3 back{kSin30 * kCos20, kSin20, kCos30*kCos20}, right{kCos30, 0, -kSin30},
      up{-kSin30 * kSin20, kCos20, -kCos30*kSin20};
  Point3 high{0, 1, 0};  ///< where the sky is
  /// Puts z up instead of y, seen from the y that scans turn their faces to.
  void turn() {
    for (Point3* v : {&back, &right, &up, &high})
      *v = {-(*v)[0], (*v)[2], (*v)[1]};
  }
};
constexpr double kAngleDeg = 30, kTangentOfHalf = 0.2679491924311227;

/// How far points reach to both sides of a pyramid's axis, along which the eye looks, when its
/// sides have a slope: |x| <= slope (d - back).
struct Extent {
  double plus = -1e300, minus = -1e300;
  void add(double x, double back, double slope) {
    plus = std::max(plus, x + slope * back);
    minus = std::max(minus, slope * back - x);
  }
  double middle() const { return (plus - minus) / 2; }
  double distance(double slope) const { return (plus + minus) / (2 * slope); }
};

}  // namespace

Material default_mesh_material(bool has_colors) {
  Material m;
  m.shine = 20;
  if (has_colors) {
    m.diffuse = {0.9f, 0.9f, 0.9f};
    m.specular = {0.04f, 0.04f, 0.04f};
    m.emission = {0.0063f, 0.0063f, 0.0075f};  // the same glow through the sRGB curve
    return m;
  }
  m.diffuse = {0.80f, 0.78f, 0.75f};
  m.specular = {0.10f, 0.10f, 0.10f};
  m.emission = {0.10f, 0.10f, 0.11f};
  return m;
}

void add_default_view(SceneFile& file) {
  const std::vector<Point3> points = points_of(file.scene.geometry);
  const std::vector<float>& radii = file.scene.geometry.spheres.radius;
  const double radius = radii.empty() ? 0 : *std::ranges::max_element(radii);
  Axes axes;
  if (is_on_z(points))
    axes.turn();
  constexpr double slope = kFilledByMesh * kTangentOfHalf;
  Extent across, upward;
  double front = -1e300, behind = 1e300;
  for (const Point3& p : points) {
    const double back = dot(p, axes.back);
    across.add(dot(p, axes.right), back, slope);
    upward.add(dot(p, axes.up), back, slope);
    front = std::max(front, back);
    behind = std::min(behind, back);
  }
  // balls touch the pyramid's sides further out
  const double margin = radius * std::sqrt(1 + slope * slope);
  for (double* const side : {&across.plus, &across.minus, &upward.plus, &upward.minus})
    *side += margin;
  const double eye_back =
      std::max(across.distance(slope), upward.distance(slope));  // along axes.back
  // A tiny mesh far out must not put the eye on what it looks at in floats.
  constexpr double kFloatSteps = 1e-5, kLeast = 1e-12;
  const double middle = front + (behind - front) / 2,
               distance = std::max({eye_back - middle, kFloatSteps * max_distance(points), kLeast});
  const Point3 at =
      moved(moved(moved({0, 0, 0}, across.middle(), axes.right), upward.middle(), axes.up),
            middle,
            axes.back);
  const Point3 eye = moved(at, distance, axes.back);
  file.camera.eye = in_floats(eye);
  file.camera.at = in_floats(at);
  file.camera.up = in_floats(axes.high);
  file.camera.angle_deg = kAngleDeg;
  file.extent = extent_of(points);
  file.extent.radius += radius;
  file.extent.half_depth = (front - behind) / 2 + radius;
  for (const Point3& p : points)
    file.extent.half_width =
        std::max(file.extent.half_width, std::abs(dot(p, axes.right) - across.middle()) + margin);
  file.scene.lights = lights_around(file.camera);
  file.scene.background = {0.62f, 0.68f, 0.76f};
  if (file.colors.any())  // they are light: this looks the same through the sRGB curve
    file.scene.background = {0.34f, 0.42f, 0.54f};
  file.default_camera = file.default_light = true;
}

}  // namespace grelha
