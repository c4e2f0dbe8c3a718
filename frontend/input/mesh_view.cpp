#include "frontend/input/mesh_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
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

/// Returns true if the mesh stands on its z side far more surely than on its y side.
bool is_on_z(const std::vector<Point3>& points) {
  constexpr double kSurely = 4, kLeast = .1;
  const double z = support(points, 2);
  return z > kLeast && z > kSurely * support(points, 1);
}

/// The axis along which the points' box is at most a tenth as long as along both others; 3: none.
std::size_t thin_axis(const std::vector<Point3>& points) {
  constexpr double kThin = .1;
  const auto [low, high] = Extents(points);
  const auto size = [&](std::size_t axis) { return high[axis % 3] - low[axis % 3]; };
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (const double least = std::min(size(axis + 1), size(axis + 2));
        least > 0 && size(axis) <= kThin * least)
      return axis;
  return 3;
}

/// Returns true if the points are thin along the up direction.
bool lies(const std::vector<Point3>& points, const Float3& up) {
  constexpr double kAlong = .99;  // the cosine
  const std::size_t thin = thin_axis(points);
  const Point3 pole = in_double(up);
  return thin < 3 && std::abs(pole[thin]) >= kAlong * length(pole);
}

/// Scans have y up, most other meshes z. A sheet lies.
Float3 up_by_shape(const std::vector<Point3>& points) {
  static constexpr std::array<Float3, 3> kAxes{Float3{1, 0, 0}, Float3{0, 1, 0}, Float3{0, 0, 1}};
  if (const std::size_t thin = thin_axis(points); thin < 3)
    return kAxes[thin];
  return kAxes[is_on_z(points) ? 2 : 1];
}

/// Sines and cosines are written down, for the library's last bit depends on the machine.
struct Elevation {
  double sine, cosine;
};
constexpr Elevation k20{0.3420201433256687, 0.9396926207859084},
    k40{0.6427876096865394, 0.766044443118978};
constexpr double kSin30 = 0.5, kCos30 = 0.8660254037844386;
constexpr double kAngleDeg = 30, kTangentOfHalf = 0.2679491924311227;

struct Axes {
  Axes(const Float3& high, const Elevation& eye) {
    const Point3 pole = unit_vector(in_double(high));
    const bool along_y =
        std::abs(pole[1]) >= std::abs(pole[2]) && std::abs(pole[1]) >= std::abs(pole[0]);
    const Point3 ahead = along_y ? Point3{0, 0, 1} : Point3{0, -1, 0};
    const Point3 front = unit_vector(moved(ahead, -dot(ahead, pole), pole));
    const Point3 side = cross(pole, front);
    back = moved(sum(kSin30 * eye.cosine, side, kCos30 * eye.cosine, front), eye.sine, pole);
    right = sum(kCos30, side, -kSin30, front);
    up = moved(sum(-kSin30 * eye.sine, side, -kCos30 * eye.sine, front), eye.cosine, pole);
  }
  Point3 back, right, up;
};

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

/// The body that points sweep in a turn about an axis through the middle of their box.
void add_swept(const std::vector<Point3>& points, const Float3& pole, MeshExtent& extent) {
  constexpr std::size_t kSlabs = 256;
  const Extents box(points);
  extent.center = in_floats(moved(box.low, .5, moved(box.high, -1, box.low)));
  const Point3 center = in_double(extent.center), axis = unit_vector(in_double(pole));
  const auto height = [&](const Point3& p) { return dot(moved(p, -1, center), axis); };
  extent.low = extent.high = height(points[0]);
  for (const Point3& p : points) {
    extent.low = std::min(extent.low, height(p));
    extent.high = std::max(extent.high, height(p));
  }
  extent.radii.assign(kSlabs, -1);
  double most = 0;
  for (const Point3& p : points) {
    const double h = height(p), share = (h - extent.low) / (extent.high - extent.low);
    const auto slab = share < 1 ? static_cast<std::size_t>(kSlabs * share) : kSlabs - 1;
    const double radius = length(moved(moved(p, -1, center), -h, axis));
    extent.radii[slab] = std::max(extent.radii[slab], radius);
    most = std::max(most, radius);
  }
  if (most == 0 && extent.low == extent.high && extent.margin == 0)
    extent.radii.clear();  // one point fills nothing
}

/// How far the swept body reaches upward and downward in a picture, and to a side: distances from
/// the planes through its center that slope towards the eye as the picture's sides do.
struct Reach {
  Reach(const MeshExtent& mesh, const CameraAxes& axes, const Point3& pole, double y, double x) {
    const double c = dot(axes.up, pole), s = dot(axes.back, pole);
    const double step = (mesh.high - mesh.low) / static_cast<double>(mesh.radii.size());
    for (std::size_t i = 0; i < 2 * mesh.radii.size(); ++i) {  // both rims of each slab
      const double radius = mesh.radii[i / 2];
      if (radius < 0)
        continue;
      const double h = mesh.low + step * static_cast<double>(i / 2 + i % 2);
      up = std::max(up, h * (c + y * s) + radius * std::abs(y * c - s));
      down = std::max(down, h * (y * s - c) + radius * std::abs(y * c + s));
      side = std::max(side, x * h * s + radius * std::sqrt(1 + x * c * x * c));
    }
    up += mesh.margin * std::sqrt(1 + y * y);
    down += mesh.margin * std::sqrt(1 + y * y);
    side += mesh.margin * std::sqrt(1 + x * x);
  }
  double up = -1e300, down = -1e300, side = -1e300;
};

/// In floats, without bits that are lost where the offset of a frame is added.
Float3 in_steps(Point3 p, double distance) {
  const double step = std::ldexp(1, std::ilogb(distance) - 24);
  for (double& c : p)
    c = step * std::round(c / step);
  return in_floats(p);
}

// A tiny mesh far out must not put the eye on what it looks at in floats.
constexpr double kFloatSteps = 1e-5, kLeastDistance = 1e-12;

}  // namespace

MeshView mesh_view(const Geometry& geometry, const std::optional<Float3>& wanted_up) {
  const std::vector<Point3> points = points_of(geometry);
  const std::vector<float>& radii = geometry.spheres.radius;
  MeshView view;
  view.extent.margin = radii.empty() ? 0 : *std::ranges::max_element(radii);
  view.camera.up = wanted_up ? *wanted_up : up_by_shape(points);
  const Axes axes(view.camera.up, lies(points, view.camera.up) ? k40 : k20);
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
  const double margin = view.extent.margin * std::sqrt(1 + slope * slope);
  for (double* const side : {&across.plus, &across.minus, &upward.plus, &upward.minus})
    *side += margin;
  const double eye_back =
      std::max(across.distance(slope), upward.distance(slope));  // along axes.back
  const double middle = front + (behind - front) / 2;
  const double distance =
      std::max({eye_back - middle, kFloatSteps * max_distance(points), kLeastDistance});
  const Point3 at =
      moved(moved(moved({0, 0, 0}, across.middle(), axes.right), upward.middle(), axes.up),
            middle,
            axes.back);
  view.camera.eye = in_steps(moved(at, distance, axes.back), distance);
  view.camera.at = in_steps(at, distance);
  view.camera.angle_deg = kAngleDeg;
  view.extent.half_depth = (front - behind) / 2 + view.extent.margin;
  for (const Point3& p : points)
    view.extent.half_width =
        std::max(view.extent.half_width, std::abs(dot(p, axes.right) - across.middle()) + margin);
  add_swept(points, view.camera.up, view.extent);
  return view;
}

void fit_width(const MeshExtent& mesh, Camera& camera) {
  if (camera.width >= camera.height)
    return;
  const CameraAxes axes(camera);
  const double slope = kFilledByMesh * pixel_size(camera) * camera.width / 2;
  const double distance = std::max(axes.distance, mesh.half_depth + mesh.half_width / slope);
  camera.eye = in_floats(sum(1, in_double(camera.at), distance, axes.back));
}

void fit_turned(const MeshExtent& mesh, const Float3& high, bool fit_height, Camera& camera) {
  const CameraAxes axes(camera);
  const Point3 pole = unit_vector(in_double(high)), center = in_double(mesh.center);
  Camera wide = camera;  // an orthographic camera stands where another would
  wide.orthographic_height = 0;
  const double half = kFilledByMesh * pixel_size(wide) / 2;
  const double y = half * camera.height, x = half * camera.width;
  const Reach reach(mesh, axes, pole, y, x);
  double shift = (reach.up - reach.down) / 2;
  const double distance = std::max({(reach.up + reach.down) / (2 * y),
                                    reach.side / x,
                                    kFloatSteps * max_distance({center}),
                                    kLeastDistance});
  if (camera.orthographic_height > 0) {
    const Reach parallel(mesh, axes, pole, 0, 0);
    shift = (parallel.up - parallel.down) / 2;
    if (fit_height)
      camera.orthographic_height =
          std::max(parallel.up + parallel.down, 2 * parallel.side * camera.height / camera.width) /
          kFilledByMesh;
  }
  const Point3 at = moved(center, shift, axes.up);
  camera.at = in_steps(at, distance);
  camera.eye = in_steps(moved(at, distance, axes.back), distance);
}

}  // namespace grelha
