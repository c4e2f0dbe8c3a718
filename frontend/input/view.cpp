#include "frontend/input/view.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "frontend/images/tone.hpp"
#include "frontend/input/mesh_view.hpp"
#include "frontend/scene/double3.hpp"
#include "kernel/base/sine.hpp"

namespace grelha {
namespace {

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

void go_around(const Orbit& by, Camera& camera) {
  const CameraAxes axes(camera);
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
  camera.eye = in_floats(sum(1, in_double(camera.at), axes.distance, to_eye));
  if (by.elevation_deg != 0)  // `up` may be along the view
    camera.up = in_floats(sum(elevation.cosine, up, -elevation.sine, back));
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

View view_of(const SceneFile& file, const ViewOptions& options) {
  View view = view_of(file);
  turn_up(file.scene.geometry, options, view);
  return view;
}

void turn_up(const Geometry& geometry, const ViewOptions& options, View& view) {
  if (!view.extent.is_known() || !options.up || options.eye || options.at ||
      is_zero(*options.up))  // which changed() refuses
    return;
  const int width = view.camera.width, height = view.camera.height;
  const MeshView anew = mesh_view(geometry, in_floats(*options.up));
  view.camera = anew.camera;
  view.camera.width = width;
  view.camera.height = height;
  view.extent = anew.extent;
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

namespace {

/// The camera with what options say of it, but for the orbit.
void replace(const ViewOptions& options, const Frame& frame, Camera& camera) {
  if (options.eye)
    camera.eye = frame.inside(*options.eye);
  if (options.at)
    camera.at = frame.inside(*options.at);
  if (options.up)
    camera.up = in_floats(*options.up);
  camera.angle_deg = options.angle_deg.value_or(camera.angle_deg);
  if (const auto& height = options.orthographic_height)
    camera.orthographic_height = *height == 0 ? 1 : *height * frame.scale;
  expect_valid(camera);
}

}  // namespace

View changed(View view, const ViewOptions& options, const Frame& frame) {
  Camera& camera = view.camera;
  replace(options, frame, camera);
  const bool fits = view.extent.is_known() && !options.eye && !options.at;
  const bool fit_height = options.orthographic_height == 0;
  if (fit_height && !fits)
    throw std::invalid_argument(
        "--orthographic auto: expected a mesh without a scene, seen without --eye and --at");
  const Float3 pole = camera.up;
  if (options.orbit)
    go_around(*options.orbit, camera);
  if (fits && (options.orbit || camera.orthographic_height > 0))
    fit_turned(view.extent, pole, fit_height, camera);
  else if (fits)
    fit_width(view.extent, camera);
  const double zoom = options.orbit ? options.orbit->zoom : 1;
  camera.angle_deg /= zoom;
  camera.orthographic_height /= zoom;
  expect_valid(camera);
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

void add_default_view(SceneFile& file, const std::optional<Float3>& up) {
  const MeshView view = mesh_view(file.scene.geometry, up);
  file.camera = view.camera;
  file.extent = view.extent;
  file.scene.lights = lights_around(file.camera);
  file.scene.background = {0.62f, 0.68f, 0.76f};
  if (file.colors.any())  // they are light: this looks the same through the sRGB curve
    file.scene.background = {0.34f, 0.42f, 0.54f};
  file.default_camera = file.default_light = true;
}

}  // namespace grelha
