#include "frontend/input/view.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "frontend/images/tone.hpp"
#include "frontend/scene/double3.hpp"
#include "kernel/base/sine.hpp"

namespace grelha {
namespace {

Double3 unit_vector(const Double3& a) {
  return sum(1 / length(a), a, 0, a);
}

/// Of any angle; of whole quarter turns exactly.
SineCosine of_degrees(double degrees) {
  const auto [s, c] = sine_cosine(std::remainder(degrees, 90) * 3.14159265358979323846 / 180);
  switch (std::lround((degrees - std::remainder(degrees, 90)) / 90) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

/// The axes of a valid camera: from `at` to the eye, to its right and up.
struct CameraAxes {
  explicit CameraAxes(const Camera& c)
      : back(difference(c.eye, c.at)),
        distance(length(back)),
        right(unit_vector(cross(in_double(c.up), back))),
        up(unit_vector(cross(back, right))) {
    back = unit_vector(back);
  }
  Double3 back;
  double distance;
  Double3 right, up;
};

/// The distance at which a ball fills the picture as a bare mesh does.
double distance_of(double radius, const Camera& camera) {
  const double tangent =
      kFilledByMesh * pixel_size(camera) * std::min(camera.width, camera.height) / 2;
  return radius * std::sqrt(1 + tangent * tangent) / tangent;
}

/// Steps back with the made-up camera, which shows its mesh in a square, until a narrower picture
/// shows it as well.
void fit_width(const MeshExtent& mesh, Camera& camera) {
  const CameraAxes axes(camera);
  const double slope = kFilledByMesh * pixel_size(camera) * camera.width / 2;
  const double distance = std::max(axes.distance, mesh.half_depth + mesh.half_width / slope);
  camera.eye = in_floats(sum(1, in_double(camera.at), distance, axes.back));
}

void go_around(const Orbit& by, double distance, Camera& camera) {
  CameraAxes axes(camera);
  const Double3 pole = unit_vector(in_double(camera.up));
  const SineCosine azimuth = of_degrees(by.azimuth_deg);
  const SineCosine elevation = of_degrees(by.elevation_deg);
  const auto turned = [&](const Double3& v) {  // Rodrigues' formula
    return sum(1,
               sum(azimuth.cosine, v, azimuth.sine, cross(pole, v)),
               (1 - azimuth.cosine) * dot(pole, v),
               pole);
  };
  const Double3 back = turned(axes.back), up = turned(axes.up);
  const Double3 to_eye = sum(elevation.cosine, back, elevation.sine, up);
  camera.eye = in_floats(sum(1, in_double(camera.at), distance, to_eye));
  if (by.elevation_deg != 0)  // `up` may be along the view
    camera.up = in_floats(sum(elevation.cosine, up, -elevation.sine, back));
  camera.angle_deg /= by.zoom;
  camera.orthographic_height /= by.zoom;
}

void expect_valid(const Camera& camera) {
  if (!camera_is_valid(camera))
    throw std::invalid_argument(
        "eye, at, up, angle: expected finite numbers, eye apart from at, up not along the view, "
        "and an angle between 0 and 180 degrees");
}

/// The shortest decimals that read back as the same; 0 of -0.
template <class Number>
std::string shortest(Number value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value + 0).ptr};
}

std::string joined(const std::array<std::string, 3>& words, const std::string& between) {
  return words[0] + between + words[1] + between + words[2];
}

std::array<std::string, 3> words_of(const Float3& v) {
  return {shortest(v.x), shortest(v.y), shortest(v.z)};
}

/// Of a point in the file's coordinates.
std::array<std::string, 3> words_of(const Float3& v, const Frame& frame) {
  const auto [x, y, z] = frame.outside(v);
  return frame == Frame{} ? words_of(v) : std::array{shortest(x), shortest(y), shortest(z)};
}

}  // namespace

std::vector<std::string> lines_of(const View& view, const Frame& frame) {
  const Camera& c = view.camera;
  const auto eye = words_of(c.eye, frame), at = words_of(c.at, frame), up = words_of(c.up);
  const std::string angle = shortest(c.angle_deg);
  std::vector<std::string> lines{"--eye " + joined(eye, ",") + " --at " + joined(at, ",") +
                                 " --up " + joined(up, ",") + " --angle " + angle};
  if (c.orthographic_height > 0)
    lines[0] += " --orthographic " + shortest(c.orthographic_height / frame.scale);
  else
    lines.push_back("v from " + joined(eye, " ") + " at " + joined(at, " ") + " up " +
                    joined(up, " ") + " angle " + angle + " resolution " + std::to_string(c.width) +
                    ' ' + std::to_string(c.height));
  if (!view.made_up_lights)
    return lines;
  for (const Light& light : view.lighting.lights)
    lines.push_back("l " + joined(words_of(light.position, frame), " ") + ' ' +
                    joined(words_of(light.color), " "));
  lines.push_back("b " + joined(words_of(view.lighting.background), " "));
  return lines;
}

ViewOptions with_background(ViewOptions options, bool colors_are_light) {
  const auto light = [](float c) { return static_cast<float>(light_of_srgb(double{c})); };
  if (const auto b = options.background; b && options.background_is_encoded && colors_are_light)
    options.background = Float3{light(b->x), light(b->y), light(b->z)};
  return options;
}

void warn_of_background(const std::string& path, const ViewOptions& options, const Warn& warn) {
  if (!options.background || options.background_is_encoded)
    return;
  const Float3 b = *options.background;
  const float channels[] = {b.x, b.y, b.z};
  const float most = std::ranges::max(channels);
  if (most > 1 && std::ranges::all_of(channels, [](float c) { return c == std::floor(c); }))
    warn(path + ": warning: --background " + joined(words_of(b), ",") + " is " + shortest(most) +
         " times as bright as white, which is 1; #rrggbb takes bytes");
}

View view_of(const SceneFile& file) {
  return {file.camera, {file.scene.lights, file.scene.background}, file.default_light, file.extent};
}

void apply_view(const View& own, const ViewOptions& options, SceneFile& file) {
  if (options.lights_follow && !file.default_light)
    throw std::invalid_argument(
        "--lights: expected a mesh without lights, found a scene with its own");
  View view = changed(own, options, file.frame);
  file.camera = view.camera;
  file.scene.lights = std::move(view.lighting.lights);
  file.scene.background = view.lighting.background;
}

View changed(View view, const ViewOptions& options, const Frame& frame) {
  Camera& camera = view.camera;
  if (options.eye)
    camera.eye = frame.inside(*options.eye);
  if (options.at)
    camera.at = frame.inside(*options.at);
  if (options.up)
    camera.up = in_floats(*options.up);
  camera.angle_deg = options.angle_deg.value_or(camera.angle_deg);
  if (options.orthographic_height)
    camera.orthographic_height = *options.orthographic_height * frame.scale;
  expect_valid(camera);
  const bool fits = view.extent.radius > 0 && !options.eye && !options.at;
  if (fits && camera.width < camera.height && camera.orthographic_height == 0)
    fit_width(view.extent, camera);
  if (options.orbit) {
    double distance = CameraAxes(camera).distance;
    if (fits) {
      Camera wide = camera;  // an orthographic camera stands where another would
      wide.orthographic_height = 0;
      distance = distance_of(view.extent.radius, wide);
      camera.eye = camera.eye + (view.extent.center - camera.at);
      camera.at = view.extent.center;
    }
    go_around(*options.orbit, distance, camera);
    expect_valid(camera);
  }
  if (view.made_up_lights && options.lights_follow.value_or(true))
    view.lighting.lights = lights_around(camera);
  view.lighting.background = options.background.value_or(view.lighting.background);
  return view;
}

std::vector<Light> lights_around(const Camera& camera) {
  const CameraAxes axes(camera);
  const auto position = [&](double to_back, double to_right, double up) {
    const Double3 across = sum(axes.distance * to_right, axes.right, axes.distance * up, axes.up);
    return in_floats(
        sum(1, in_double(camera.at), 1, sum(axes.distance * to_back, axes.back, 1, across)));
  };
  return {{position(1.2, -.55, .6), {.82f, .78f, .70f}, {}, {}},
          {camera.eye, {.30f, .32f, .37f}, {}, {}},
          {position(-.4, .8, .55), {.34f, .38f, .44f}, {}, {}}};
}

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
