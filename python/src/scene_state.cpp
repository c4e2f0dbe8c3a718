// A Scene as plain arrays and numbers, and back.
#include <array>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

#include "src/file_scene.hpp"
#include "src/pickle.hpp"

namespace grelha::python {
namespace {

constexpr std::size_t kMaterialFloats = 17;
constexpr std::size_t kLightFloats = 12;

template <class Visit>
void each_float(Float3& v, const Visit& visit) {
  visit(v.x);
  visit(v.y);
  visit(v.z);
}

template <class Visit>
void each_float(Material& m, const Visit& visit) {
  for (Float3* const colour : {&m.diffuse, &m.specular, &m.mirror, &m.emission})
    each_float(*colour, visit);
  for (float* const number : {&m.transmission, &m.shine, &m.ior, &m.roughness})
    visit(*number);
  float fresnel = m.fresnel ? 1 : 0;
  visit(fresnel);
  m.fresnel = fresnel != 0;
}

template <class Visit>
void each_float(Light& l, const Visit& visit) {
  for (Float3* const v : {&l.position, &l.color, &l.edge1, &l.edge2})
    each_float(*v, visit);
}

template <class T>
py::array_t<float> floats_of(const std::vector<T>& things, std::size_t floats) {
  py::array_t<float> all(Shape{py::ssize_t(things.size()), py::ssize_t(floats)});
  float* to = all.mutable_data();
  for (T thing : things)
    each_float(thing, [&](float& value) { *to++ = value; });
  return all;
}

template <class T>
std::vector<T> things_of(py::handle given, std::size_t floats) {
  const auto all = py::array_t<float, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!all || all.ndim() != 2 || all.shape(1) != py::ssize_t(floats))
    throw py::value_error("state: expected rows of " + std::to_string(floats) + " numbers");
  std::vector<T> things(std::size_t(all.shape(0)));
  const float* from = all.data();
  for (T& thing : things)
    each_float(thing, [&](float& value) { value = *from++; });
  return things;
}

py::tuple point(const Float3& p) {
  return py::make_tuple(p.x, p.y, p.z);
}

Float3 point_of(const py::handle& given) {
  const auto p = given.cast<std::array<float, 3>>();
  return {p[0], p[1], p[2]};
}

py::tuple extent_state(const MeshExtent& e) {
  return py::make_tuple(
      point(e.center), e.margin, e.low, e.high, e.radii, e.half_width, e.half_depth);
}

MeshExtent extent_of(const py::tuple& state) {
  if (state.size() != 7)
    throw py::value_error("state: expected an extent of 7 parts");
  return {point_of(state[0]),
          state[1].cast<double>(),
          state[2].cast<double>(),
          state[3].cast<double>(),
          state[4].cast<std::vector<double>>(),
          state[5].cast<double>(),
          state[6].cast<double>()};
}

py::tuple tuple_of_camera(const Camera& c) {
  return py::make_tuple(
      point(c.eye), point(c.at), point(c.up), c.angle_deg, c.width, c.height, c.aperture, c.focus);
}

Camera camera_of(const py::tuple& state) {
  if (state.size() != 8)
    throw py::value_error("state: expected a camera of 8 parts");
  Camera c;
  c.eye = point_of(state[0]);
  c.at = point_of(state[1]);
  c.up = point_of(state[2]);
  c.angle_deg = state[3].cast<double>();
  c.width = state[4].cast<int>();
  c.height = state[5].cast<int>();
  c.aperture = state[6].cast<double>();
  c.focus = state[7].cast<double>();
  if (!camera_is_valid(c) || c.width < 1 || c.width > kMostSide || c.height < 1 ||
      c.height > kMostSide)
    throw py::value_error("state: expected a camera that sees");
  return c;
}

}  // namespace

py::tuple FileScene::state() const {
  const Scene& s = model_->scene();
  py::list solids;
  for (const auto& [name, first, count] : solids_)
    solids.append(py::make_tuple(py::bytes(name), first, count));
  return py::make_tuple(state_of(*model_),
                        floats_of(s.materials, kMaterialFloats),
                        floats_of(view_.lighting.lights, kLightFloats),
                        floats_of(std::vector<Float3>{view_.lighting.background}, 3),
                        tuple_of_camera(view_.camera),
                        py::make_tuple(view_.made_up_lights, extent_state(view_.extent), samples_),
                        solids);
}

FileScene FileScene::of_state(const py::tuple& state) {
  if (state.size() != 7)
    throw py::value_error("state: expected that of a Scene of this version of grelha");
  ModelParts parts = parts_of_state(state[0].cast<py::tuple>());
  parts.scene.materials = things_of<Material>(state[1], kMaterialFloats);
  const auto background = things_of<Float3>(state[3], 3);
  if (background.size() != 1)
    throw py::value_error("state: expected one background");
  FileScene scene;
  const auto [made_up, extent, samples] = state[5].cast<std::tuple<bool, py::tuple, int>>();
  scene.view_ = {camera_of(state[4].cast<py::tuple>()),
                 {things_of<Light>(state[2], kLightFloats), background[0]},
                 made_up,
                 extent_of(extent)};
  scene.samples_ = samples;
  if (scene.samples_ < 1 || scene.samples_ > kMostSamples)
    throw py::value_error("state: expected 1 sample or more");
  if (!py::isinstance<py::list>(state[6]))
    throw py::value_error("state: expected a list of solids");
  for (const py::handle solid : state[6]) {
    const auto [name, first, count] =
        solid.cast<std::tuple<py::bytes, std::uint32_t, std::uint32_t>>();
    if (std::uint64_t{first} + count > parts.scene.geometry.triangles.size())
      throw py::value_error("state: expected solids of faces that are there");
    scene.solids_.push_back({std::string(name), first, count});
  }
  scene.model_ = built(std::move(parts), 0);
  return scene;
}

}  // namespace grelha::python
