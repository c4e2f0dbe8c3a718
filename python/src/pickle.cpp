#include "src/pickle.hpp"

#include <algorithm>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace grelha::python {
namespace {

constexpr int kVersion = 1;

/// Calls visit(name, vector) for each array of floats or indices.
template <class Geometry, class Visit>
void each_array(Geometry& g, const Visit& visit) {
  std::istringstream names(
      "sphere_x sphere_y sphere_z sphere_radius sphere_material x y z nx ny nz red green blue a b "
      "c material "
      "base_x base_y base_z apex_x apex_y apex_z base_radius apex_radius cone_material "
      "plane_x plane_y plane_z plane_nx plane_ny plane_nz plane_material");
  std::string name;
  const auto all = [&](auto&... arrays) { ((names >> name, visit(name.c_str(), arrays)), ...); };
  auto& [s, t, c, p, objects] = g;
  all(s.x, s.y, s.z, s.radius, s.material);
  all(t.x, t.y, t.z, t.nx, t.ny, t.nz, t.red, t.green, t.blue);
  all(t.a, t.b, t.c, t.material);
  all(c.base_x, c.base_y, c.base_z, c.apex_x, c.apex_y, c.apex_z);
  all(c.base_radius, c.apex_radius, c.material);
  all(p.x, p.y, p.z, p.nx, p.ny, p.nz, p.material);
}

template <class T>
std::vector<T> vector_of(const py::handle& given) {
  const auto array = py::array_t<T, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!array || array.ndim() != 1)
    throw py::value_error("state: expected arrays of one axis");
  return {array.data(), array.data() + array.size()};
}

std::vector<Object> objects_in(const py::handle& given) {
  const std::vector<std::uint32_t> ranges = vector_of<std::uint32_t>(given);
  if (ranges.size() % 3 != 0)
    throw py::value_error("state: expected three numbers of each mesh");
  std::vector<Object> objects;
  for (std::size_t i = 0; i < ranges.size(); i += 3)
    objects.push_back({ranges[i], ranges[i + 1], ranges[i + 2] != 0});
  return objects;
}

std::vector<double> doubles_in(const py::handle& given, std::size_t vertices) {
  std::vector<double> all = vector_of<double>(given);
  if (all.size() != 3 * vertices)
    throw py::value_error("state: expected three doubles of each vertex");
  return all;
}

}  // namespace

py::tuple state_of(const Model& model) {
  py::dict arrays;
  each_array(model.geometry(), [&](const char* name, const auto& values) {
    using T = typename std::decay_t<decltype(values)>::value_type;
    if (!values.empty())
      arrays[name] = py::array_t<T>(py::ssize_t(values.size()), values.data());
  });
  if (const std::vector<double>& all = model.scene().doubles; !all.empty())
    arrays["doubles"] = py::array_t<double>(py::ssize_t(all.size()), all.data());
  const std::vector<Object>& objects = model.geometry().objects;
  std::vector<std::uint32_t> ranges;
  for (const Object& o : objects)
    ranges.insert(ranges.end(), {o.first_triangle, o.triangle_count, o.visible ? 1u : 0u});
  const std::vector<std::uint32_t>& first = model.scene().first_vertices;
  const auto& offset = model.frame.offset;
  return py::make_tuple(kVersion,
                        arrays,
                        py::array_t<std::uint32_t>(py::ssize_t(ranges.size()), ranges.data()),
                        py::make_tuple(offset[0], offset[1], offset[2]),
                        model.frame.scale,
                        model.in_double,
                        py::array_t<std::uint32_t>(py::ssize_t(first.size()), first.data()));
}

ModelParts parts_of_state(const py::tuple& state) {
  if (state.size() != 7 || !py::isinstance<py::int_>(state[0]) || state[0].cast<int>() != kVersion)
    throw py::value_error("state: expected that of a World of this version of grelha");
  ModelParts parts;
  Geometry& g = parts.scene.geometry;
  const auto arrays = state[1].cast<py::dict>();
  std::uint32_t materials = 0;
  each_array(g, [&](const char* name, auto& values) {
    using T = typename std::decay_t<decltype(values)>::value_type;
    if (arrays.contains(name))
      values = vector_of<T>(arrays[name]);
  });
  for (const auto* const used :
       {&g.spheres.material, &g.triangles.material, &g.cones.material, &g.planes.material})
    for (const std::uint32_t m : *used)
      materials = std::max(materials, m);
  if (materials >= 0x1000000)
    throw py::value_error("state: expected fewer materials");
  parts.scene.materials.resize(materials + std::size_t{1});
  g.objects = objects_in(state[2]);
  const auto offset = state[3].cast<py::tuple>();
  for (std::size_t a = 0; a < 3; ++a)
    parts.scene.offset[a] = offset[a].cast<double>();
  parts.scale = state[4].cast<double>();
  parts.in_double = state[5].cast<bool>();
  parts.scene.first_vertices = vector_of<std::uint32_t>(state[6]);
  const std::vector<std::uint32_t>& first = parts.scene.first_vertices;
  if (!first.empty() &&
      (first.size() != g.objects.size() + 1 || first.front() != 0 ||
       first.back() != g.triangles.vertex_count() || !std::is_sorted(first.begin(), first.end())))
    throw py::value_error("state: expected vertices of each mesh");
  if (arrays.contains("doubles"))
    parts.scene.doubles = doubles_in(arrays["doubles"], g.triangles.vertex_count());
  return parts;
}

SharedModel model_of(const py::tuple& state) {
  return built(parts_of_state(state), 0);
}

}  // namespace grelha::python
