#include "src/file_scene.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "frontend/commands/layers.hpp"
#include "frontend/input/effects.hpp"
#include "frontend/input/read_scene.hpp"
#include "frontend/input/view.hpp"
#include "frontend/scene/mesh.hpp"
#include "frontend/scene/scene_builder.hpp"
#include "grelha/render.hpp"
#include "src/hear.hpp"
#include "src/materials.hpp"
#include "src/meshes.hpp"

namespace grelha::python {
namespace {

void warn(const std::vector<std::string>& lines) {
  for (const std::string& line : lines)
    if (PyErr_WarnEx(PyExc_UserWarning, line.c_str(), 1) != 0)
      throw py::error_already_set();
}

py::tuple tuple_of(const std::array<double, 3>& v) {
  return py::make_tuple(v[0], v[1], v[2]);
}

using Point = std::array<double, 3>;

/// None is absent.
ViewOptions::Point point_in(py::handle given, const char* name) {
  if (given.is_none())
    return {};
  const Triples v(given, name);
  if (!v.shape().empty())
    wrong_value(name, "shape (3,)", text_of(v.full_shape()));
  const PointArray& p = v.points();
  return Point{p.at(0, 0), p.at(0, 1), p.at(0, 2)};
}

std::optional<double> optional_number(py::handle given, const char* name) {
  return given.is_none() ? std::nullopt : std::optional(number_in(given, name));
}

/// 0 of "auto".
std::optional<double> height_in(py::handle given) {
  if (py::isinstance<py::str>(given) && given.equal(py::str("auto")))
    return 0;
  const std::optional<double> height = optional_number(given, "orthographic");
  if (height && !(*height > 0 && *height <= kLargestLength))
    wrong_value("orthographic", "a height above 0, at most 1e18", std::to_string(*height));
  return height;
}

Orbit orbit_in(py::handle given) {
  const Doubles numbers(given, "orbit");
  const Shape& shape = numbers.shape();
  if (!shape.empty() && shape != Shape{2} && shape != Shape{3})
    wrong_value("orbit", "azimuth, or azimuth, elevation and perhaps zoom", text_of(shape));
  Orbit orbit{numbers.all};
  if (!shape.empty()) {
    const py::array_t<double> v(given.cast<py::object>());
    orbit = {v.at(0), v.at(1), v.size() == 3 ? v.at(2) : 1};
  }
  if (!(std::abs(orbit.azimuth_deg) <= kMostTurn && std::abs(orbit.elevation_deg) <= kMostTurn))
    wrong_value("orbit", "degrees, at most 100 turns", py::str(given));
  if (!(orbit.zoom >= kLeastZoom && orbit.zoom <= kMostZoom))
    wrong_value("orbit", "a zoom of .001 to 1000", std::to_string(orbit.zoom));
  return orbit;
}

std::vector<Light> lights_in(py::handle given, const Frame& frame) {
  if (const py::array none = py::array::ensure(given); none && none.size() == 0)
    return {};
  PyErr_Clear();
  const Triples v(given, "lights");
  if (v.shape().size() != 2 || v.shape()[1] != 2)
    wrong_value("lights", "shape (n, 2, 3), of positions and colours", text_of(v.full_shape()));
  const auto at = [&](std::size_t i) {
    return Point{v.points().at(i, 0), v.points().at(i, 1), v.points().at(i, 2)};
  };
  std::vector<Light> lights;
  for (std::size_t i = 0; i < v.count(); i += 2) {
    const Float3 position = frame.inside(at(i));
    if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z))
      wrong_value(
          "lights", "finite positions", "one that is not, in light " + std::to_string(i / 2));
    lights.push_back({position, color_of(at(i + 1), "lights"), {}, {}});
  }
  return lights;
}

/// The same view where the scene lies in another frame.
View in_frame(View view, const Frame& from, const Frame& to) {
  if (from == to)
    return view;
  const double scale = to.scale / from.scale;
  const auto move = [&](Float3& point) { point = to.inside(from.outside(point)); };
  const auto stretch = [&](Float3& edge) { edge = float(scale) * edge; };
  for (Float3* const point : {&view.camera.eye, &view.camera.at, &view.extent.center})
    move(*point);
  for (double* const length : {&view.camera.aperture,
                               &view.camera.focus,
                               &view.camera.orthographic_height,
                               &view.extent.margin,
                               &view.extent.low,
                               &view.extent.high,
                               &view.extent.half_width,
                               &view.extent.half_depth})
    *length *= scale;
  for (double& radius : view.extent.radii)
    radius *= scale;
  for (Light& light : view.lighting.lights) {
    move(light.position);
    stretch(light.edge1);
    stretch(light.edge2);
  }
  return view;
}

/// A scene whose vertices moved with those normals that they had: now means of their faces'.
void renew_normals(Triangles& t) {
  const Triangles before = t;
  for (std::vector<float>* const axis : {&t.nx, &t.ny, &t.nz})
    axis->clear();
  smooth_normals(t, 0, 180);
  for (std::size_t i = 0; i < t.vertex_count(); ++i)
    if (before.nx[i] == 0 && before.ny[i] == 0 && before.nz[i] == 0)
      t.nx[i] = t.ny[i] = t.nz[i] = 0;
}

}  // namespace

FileScene FileScene::of_world(const SharedModel& world) const {
  FileScene scene = *this;
  scene.view_ = in_frame(view_, model_->frame, world->frame);
  scene.model_ = world;
  if (world->geometry().triangles.nx.empty())
    return scene;
  ModelParts parts{world->scene(), world->frame.scale, world->in_double};
  renew_normals(parts.scene.geometry.triangles);
  scene.model_ = built(std::move(parts), 0, world.get());
  return scene;
}

FileScene FileScene::without_model(SceneFile& file) {
  FileScene scene;
  RenderOptions options;
  apply_effects({}, file, options);
  scene.samples_ = options.sampling.samples;
  scene.view_ = view_of(file);
  if (file.default_camera)
    for (const NamedObject& solid : file.solids)
      scene.solids_.push_back(
          {solid.name, solid.triangles.first_triangle, solid.triangles.triangle_count});
  return scene;
}

FileScene FileScene::of(SceneFile file, bool in_double, int threads) {
  FileScene scene = without_model(file);
  ModelParts parts{{std::move(file.scene), file.frame.offset}, file.frame.scale, in_double};
  if (!scene.solids_.empty()) {
    for (const NamedObject& solid : file.solids)
      parts.scene.first_vertices.push_back(solid.first_vertex);
    parts.scene.first_vertices.push_back(
        std::uint32_t(parts.scene.geometry.triangles.vertex_count()));
  }
  scene.model_ = built(std::move(parts), threads);
  return scene;
}

FileScene FileScene::read(py::handle path,
                          const MeshOptions& meshes,
                          py::handle material,
                          int threads) {
  const std::string name = path_in(path);
  py::module_::import("os").attr("stat")(path);  // its errors are the ones that Python knows
  SceneFile file;
  std::vector<std::string> warnings;
  hear_signals([&](const Progress& progress) {
    ReadOptions options;
    options.progress = progress;
    options.meshes = meshes;
    const Warn keep = [&](const std::string& line) { warnings.push_back(line); };
    file = read_scene(name, keep, options);
  });
  warn(warnings);
  if (!material.is_none() && !file.default_camera)
    throw py::value_error("material: expected a mesh, found a scene with materials of its own");
  if (!material.is_none())
    put_material(material, file.scene.materials);
  const bool framed = file.frame != Frame{};
  return of(std::move(file), framed, threads);
}

FileScene FileScene::of_mesh(const MeshArguments& given, int threads) {
  ModelParts mesh = mesh_parts(given.vertices, given.faces);
  SceneFile file;
  file.frame.offset = mesh.scene.offset;
  file.scene = std::move(mesh.scene);
  const bool colored = !given.colors.is_none();
  file.scene.materials = {default_mesh_material(colored)};
  if (!given.material.is_none())
    put_material(given.material, file.scene.materials);
  if (colored)
    file.colors.of_vertices = put_colors(given.colors, file.scene);
  file.colors.of_faces = colored && !file.colors.of_vertices;
  if (const double degrees = smoothness_in(given.smooth); degrees > 0)
    smooth_normals(file.scene.geometry.triangles, 0, degrees);
  add_default_view(file);
  return of(std::move(file), mesh.in_double, threads);
}

FileScene FileScene::of_meshes(const MeshesArguments& given, int threads) {
  ModelParts parts = joined_parts(given.vertices, given.faces, given.counts);
  Triangles& t = parts.scene.geometry.triangles;
  std::vector<Material>& materials = parts.scene.materials;
  if (given.materials.empty())
    materials = {default_mesh_material()};
  else
    t.material.resize(t.size());
  for (const py::handle wanted : given.materials) {
    std::vector<Material> one{default_mesh_material()};
    if (!wanted.is_none())
      put_material(wanted, one);
    const Object& faces = parts.scene.geometry.objects.at(materials.size());
    std::fill_n(t.material.begin() + faces.first_triangle,
                faces.triangle_count,
                std::uint32_t(materials.size()));
    materials.push_back(one.front());
  }
  SceneFile file;
  file.frame.offset = parts.scene.offset;
  file.scene = parts.scene;
  add_default_view(file);
  FileScene scene = without_model(file);
  scene.model_ = built(std::move(parts), threads);
  return scene;
}

py::dict FileScene::camera() const {
  const Camera& from = view_.camera;
  py::dict camera;
  camera["eye"] = tuple_of(model_->frame.outside(from.eye));
  camera["at"] = tuple_of(model_->frame.outside(from.at));
  camera["up"] = tuple_of({from.up.x, from.up.y, from.up.z});
  camera["angle"] = from.angle_deg;
  camera["width"] = from.width;
  camera["height"] = from.height;
  return camera;
}

py::list FileScene::solids() const {
  py::list all;
  for (const auto& [name, first, count] : solids_) {
    const auto text = py::reinterpret_steal<py::object>(
        PyUnicode_DecodeUTF8(name.data(), py::ssize_t(name.size()), "replace"));
    all.append(py::make_tuple(text, first, count));
  }
  return all;
}

py::object FileScene::colors() const {
  const Triangles& t = model_->geometry().triangles;
  if (t.red.empty())
    return py::none();
  py::array_t<float> all(Shape{py::ssize_t(t.vertex_count()), 3});
  float* to = all.mutable_data();
  for (std::size_t i = 0; i < t.vertex_count(); ++i)
    for (const float channel : {t.red[i], t.green[i], t.blue[i]})
      *to++ = channel;
  return all;
}

py::array_t<double> FileScene::lights() const {
  py::array_t<double> all(Shape{py::ssize_t(view_.lighting.lights.size()), 2, 3});
  double* to = all.mutable_data();
  for (const Light& light : view_.lighting.lights) {
    to = std::ranges::copy(model_->frame.outside(light.position), to).out;
    to = std::ranges::copy(Point{light.color.x, light.color.y, light.color.z}, to).out;
  }
  return all;
}

View FileScene::view_for(const ViewArguments& given) const {
  ViewOptions options;
  options.eye = point_in(given.eye, "eye");
  options.at = point_in(given.at, "at");
  options.up = point_in(given.up, "up");
  options.angle_deg = optional_number(given.angle, "angle");
  options.orthographic_height = height_in(given.orthographic);
  if (!given.orbit.is_none())
    options.orbit = orbit_in(given.orbit);
  if (!given.background.is_none())
    options.background = color_in(given.background, "background");
  View view = view_;
  turn_up(model_->geometry(), options, view);
  if (!given.lights.is_none()) {
    view.lighting.lights = lights_in(given.lights, model_->frame);
    view.made_up_lights = false;
  }
  if (!given.width.is_none())
    view.camera.width = whole_number_in(given.width, "width", 1, kMostSide);
  if (!given.height.is_none())
    view.camera.height = whole_number_in(given.height, "height", 1, kMostSide);
  return changed(std::move(view), options, model_->frame);
}

RenderOptions FileScene::options_for(const RenderArguments& given) const {
  RenderOptions options;
  options.threads = threads_in(given.threads);
  options.depth = whole_number_in(given.depth, "depth", 1, kMostDepth);
  options.sampling.seed = std::uint32_t(whole_number_in(given.seed, "seed", 0, INT32_MAX));
  options.sampling.samples = samples_;
  const bool by_error = !given.error.is_none();
  if (!given.samples.is_none()) {
    int& samples = by_error ? options.refine.most : options.sampling.samples;
    samples = whole_number_in(given.samples, "samples", by_error ? kLeastMost : 1, kMostSamples);
  }
  if (!by_error)
    return options;
  options.refine.error = number_in(given.error, "error");
  if (!(options.refine.error > 0 && options.refine.error <= 1))
    wrong_value("error", "a number above 0, at most 1", std::to_string(options.refine.error));
  return options;
}

py::array_t<float> FileScene::render(const RenderArguments& given) const {
  View view = view_for(given.view);
  const Camera& camera = view.camera;
  RenderOptions options = options_for(given);
  if (given.transparent && options.refine.on())
    throw py::value_error("error, transparent: expected one of them, found both");
  options.lighting = std::move(view.lighting);
  py::array_t<float> pixels(Shape{camera.height, camera.width, given.transparent ? 4 : 3});
  float* to = pixels.mutable_data();
  const SharedModel model = model_;
  hear_signals([&](const Progress& progress) {
    options.progress = progress;
    RenderStats stats;
    Alpha alpha;
    const Image image = given.transparent
                            ? render_transparent(model->world(), camera, options, stats, alpha)
                            : grelha::render(model->world(), camera, options, stats);
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
      *to++ = image.rgb[i];
      if (given.transparent && i % 3 == 2)
        *to++ = alpha[i / 3];
    }
  });
  return pixels;
}

}  // namespace grelha::python
