#include "src/materials.hpp"

#include <optional>
#include <string>
#include <string_view>

#include "frontend/ply/ply_faces.hpp"
#include "frontend/scene/scene_builder.hpp"

namespace grelha::python {

Float3 color_of(const std::array<double, 3>& p, const char* name) {
  for (const double channel : p)
    if (!(channel >= 0 && channel <= kLargestLength))
      wrong_value(name, "light from 0 to 1e18", std::to_string(channel));
  return {float(p[0]), float(p[1]), float(p[2])};
}

Float3 color_in(py::handle given, const std::string& name) {
  const Doubles shape_of_given(given, name.c_str());
  if (shape_of_given.shape().empty()) {
    const double grey = number_in(given, name.c_str());
    return color_of({grey, grey, grey}, name.c_str());
  }
  const Triples v(given, name.c_str());
  if (!v.shape().empty())
    wrong_value(name.c_str(), "a number or shape (3,)", text_of(v.full_shape()));
  return color_of({v.points().at(0, 0), v.points().at(0, 1), v.points().at(0, 2)}, name.c_str());
}

bool put_colors(py::handle given, Scene& scene) {
  Triangles& triangles = scene.geometry.triangles;
  const bool bytes = py::isinstance<py::array_t<std::uint8_t>>(given);
  const Triples v(given, "colors");
  const auto shape = [](std::size_t count) { return Shape{py::ssize_t(count), 3}; };
  const bool of_vertices = v.full_shape() == shape(triangles.vertex_count());
  if (!of_vertices && v.full_shape() != shape(triangles.size()))
    wrong_value("colors",
                "shape " + text_of(shape(triangles.vertex_count())) + " or " +
                    text_of(shape(triangles.size())) + ", one a vertex or a face",
                text_of(v.full_shape()));
  Mesh mesh;
  std::vector<float>* const channels[] = {&mesh.red, &mesh.green, &mesh.blue};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < v.count(); ++i) {
      const double number = v.points().at(i, axis);
      const float light = bytes ? light_of_byte(number) : float(number);
      if (!(light >= 0 && light <= 1))
        wrong_value("colors", "uint8, or numbers from 0 to 1", std::to_string(number));
      channels[axis]->push_back(light);
    }
  if (of_vertices) {
    triangles.red = std::move(mesh.red);
    triangles.green = std::move(mesh.green);
    triangles.blue = std::move(mesh.blue);
  } else {
    triangles.material = materials_of_colors(mesh, scene.materials, 0);
  }
  return of_vertices;
}

namespace {

float at_least_0(py::handle given, const std::string& name) {
  const double number = number_in(given, name.c_str());
  if (!(number >= 0 && number <= kLargestLength))
    wrong_value(name.c_str(), "a number from 0 to 1e18", std::to_string(number));
  return float(number);
}

/// A field of a material by its name, or null; diffuse is none of them.
Float3* color_named(Material& m, std::string_view field) {
  return field == "specular"   ? &m.specular
         : field == "mirror"   ? &m.mirror
         : field == "emission" ? &m.emission
                               : nullptr;
}
float* number_named(Material& m, std::string_view field) {
  return field == "shine"          ? &m.shine
         : field == "transmission" ? &m.transmission
         : field == "ior"          ? &m.ior
         : field == "roughness"    ? &m.roughness
                                   : nullptr;
}

}  // namespace

double smoothness_in(py::handle given) {
  if (given.is_none())
    return 0;
  const double degrees = number_in(given, "smooth");
  if (!(degrees > 0 && degrees <= 180))
    wrong_value("smooth", "degrees above 0, at most 180", std::to_string(degrees));
  return degrees;
}

MeshOptions meshes_in(bool colors, py::handle points, py::handle smooth) {
  MeshOptions meshes{.colors = colors};
  const bool choose = py::isinstance<py::str>(points) && points.equal(py::str("auto"));
  if (!choose && !points.is_none()) {
    meshes.point_radius = number_in(points, "points");
    if (!(meshes.point_radius > 0 && meshes.point_radius <= kLargestLength))
      wrong_value("points", "\"auto\" or a radius above 0", std::to_string(meshes.point_radius));
  }
  meshes.smooth_deg = smoothness_in(smooth);
  return meshes;
}

void put_material(py::handle given, std::vector<Material>& materials) {
  if (!py::isinstance<py::dict>(given))
    wrong_type("material", "a dict", given);
  std::optional<Float3> diffuse;
  bool glows = false;
  Material m = materials.at(0);
  for (const auto& [key, value] : py::reinterpret_borrow<py::dict>(given)) {
    const std::string field = py::str(key), name = "material[" + field + ']';
    Float3* const color = color_named(m, field);
    float* const number = number_named(m, field);
    glows |= field == "emission";
    if (field == "diffuse")
      diffuse = color_in(value, name);
    else if (color)
      *color = color_in(value, name);
    else if (number)
      *number = at_least_0(value, name);
    else
      throw py::value_error(
          "material: expected diffuse, specular, mirror, emission, shine, transmission, ior or "
          "roughness, found \"" +
          field + '"');
  }
  if (m.transmission > 0 && !(m.ior > 0))
    throw py::value_error("material[ior]: expected a number above 0");
  for (Material& one : materials) {
    m.diffuse = one.diffuse;
    if (!glows)
      m.emission = one.emission;
    one = m;
    if (diffuse && materials.size() == 1)
      one.diffuse = *diffuse;
  }
}

}  // namespace grelha::python
