#include "src/pickle.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace grelha::python {
namespace {

constexpr int kVersion = 1;

/// Calls visit(name, vector) for each array of floats or indices.
template <class Geometry, class Visit>
void each_array(Geometry& g, const Visit& visit) {
  auto& s = g.spheres;
  visit("sphere_x", s.x);
  visit("sphere_y", s.y);
  visit("sphere_z", s.z);
  visit("sphere_radius", s.radius);
  visit("sphere_material", s.material);
  auto& t = g.triangles;
  visit("x", t.x);
  visit("y", t.y);
  visit("z", t.z);
  visit("nx", t.nx);
  visit("ny", t.ny);
  visit("nz", t.nz);
  visit("a", t.a);
  visit("b", t.b);
  visit("c", t.c);
  visit("material", t.material);
  auto& c = g.cones;
  visit("base_x", c.base_x);
  visit("base_y", c.base_y);
  visit("base_z", c.base_z);
  visit("apex_x", c.apex_x);
  visit("apex_y", c.apex_y);
  visit("apex_z", c.apex_z);
  visit("base_radius", c.base_radius);
  visit("apex_radius", c.apex_radius);
  visit("cone_material", c.material);
  auto& p = g.planes;
  visit("plane_x", p.x);
  visit("plane_y", p.y);
  visit("plane_z", p.z);
  visit("plane_nx", p.nx);
  visit("plane_ny", p.ny);
  visit("plane_nz", p.nz);
  visit("plane_material", p.material);
}

template <class T>
std::vector<T> vector_of(const py::handle& given) {
  const auto array = py::array_t<T, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!array || array.ndim() != 1)
    throw py::value_error("state: expected arrays of one axis");
  return {array.data(), array.data() + array.size()};
}

std::vector<std::uint32_t> object_ranges(const std::vector<Object>& objects) {
  std::vector<std::uint32_t> ranges;
  for (const Object& o : objects) {
    ranges.push_back(o.first_triangle);
    ranges.push_back(o.triangle_count);
  }
  return ranges;
}

}  // namespace

py::tuple state_of(const Model& model) {
  py::dict arrays;
  each_array(model.geometry(), [&](const char* name, const auto& values) {
    using T = typename std::decay_t<decltype(values)>::value_type;
    if (!values.empty())
      arrays[name] = py::array_t<T>(py::ssize_t(values.size()), values.data());
  });
  const std::vector<std::uint32_t> ranges = object_ranges(model.geometry().objects);
  const auto& offset = model.frame.offset;
  return py::make_tuple(kVersion,
                        arrays,
                        py::array_t<std::uint32_t>(py::ssize_t(ranges.size()), ranges.data()),
                        py::make_tuple(offset[0], offset[1], offset[2]),
                        model.frame.scale,
                        model.in_double);
}

ModelParts parts_of_state(const py::tuple& state) {
  if (state.size() != 6 || !py::isinstance<py::int_>(state[0]) || state[0].cast<int>() != kVersion)
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
  const std::vector<std::uint32_t> ranges = vector_of<std::uint32_t>(state[2]);
  for (std::size_t i = 0; i + 1 < ranges.size(); i += 2)
    g.objects.push_back({ranges[i], ranges[i + 1]});
  const auto offset = state[3].cast<py::tuple>();
  for (std::size_t a = 0; a < 3; ++a)
    parts.scene.offset[a] = offset[a].cast<double>();
  parts.scale = state[4].cast<double>();
  parts.in_double = state[5].cast<bool>();
  return parts;
}

SharedModel model_of(const py::tuple& state) {
  return built(parts_of_state(state), 0);
}

}  // namespace grelha::python
