#include "src/model.hpp"

#include <algorithm>

#include "src/hear.hpp"

namespace grelha::python {
namespace {

constexpr std::size_t kMostPrimitives = 0xFFFFFFFE;

/// What make() makes. It may refuse a number: then the error is Python's.
template <class Make>
auto checked(const char* name, const std::string& expected, const Make& make) {
  try {
    return make();
  } catch (const BadNumber& bad) {
    const auto row = py::ssize_t(bad.row);
    wrong_value(
        name,
        expected,
        bad.found + " at " +
            (bad.column ? text_of(Shape{row, py::ssize_t(*bad.column)}) : std::to_string(row)));
  }
}

Geometry triangles_in(py::handle given, std::size_t vertices) {
  const py::array_t<std::int64_t> ids = whole_numbers(given, "faces", "(m, 3)");
  if (ids.ndim() != 2 || ids.shape(1) != 3)
    wrong_value("faces", "shape (m, 3)", text_of(shape_of(ids)));
  const std::size_t count = std::size_t(ids.shape(0));
  if (count > kMostPrimitives)
    wrong_value("faces", "fewer than 2^32 - 1 triangles", std::to_string(count));
  return checked("faces", "indices of " + std::to_string(vertices) + " vertices", [&] {
    const auto* const faces = reinterpret_cast<const std::array<std::int64_t, 3>*>(ids.data());
    return triangles_of<std::int64_t>({faces, count}, vertices);
  });
}

/// Radii as given, one for each center.
Geometry spheres_in(py::handle given, const Shape& shape) {
  Numbers radii(given, "radii");
  Shape all = shape;
  if (!broadcast(all, radii.shape()) || all != shape)
    wrong_value("radii", "a number or shape " + text_of(shape), text_of(radii.shape()));
  radii.fill(shape);
  return checked(
      "radii", "numbers above 0 of at most 1e18", [&] { return spheres_of<float>(radii.each); });
}

/// Points of shape (n, 3), at most so many.
Triples rows_in(py::handle given, const char* name, std::size_t most, const char* expected) {
  Triples points(given, name);
  if (points.shape().size() != 1)
    wrong_value(name, "shape (n, 3)", text_of(points.full_shape()));
  if (points.count() > most)
    wrong_value(name, expected, std::to_string(points.count()));
  return points;
}

}  // namespace

Triples vertices_in(py::handle given) {
  return rows_in(given, "vertices", kMostPrimitives + 1, "fewer than 2^32 points");
}

ModelParts parts_of(const Triples& given, Geometry shapes) {
  const PointArray& points = given.points();
  return checked(points.name, "finite numbers of at most 1e18", [&] {
    return ModelParts{scene_of(points, std::move(shapes)), 1, points.in_double};
  });
}

SharedModel built(ModelParts parts,
                  int threads,
                  const Model* before,
                  std::span<const Object> moved) {
  SharedModel model;
  const Geometry& g = parts.scene.geometry;
  const std::size_t n = g.planes.size() + g.spheres.size() + g.triangles.size() + g.cones.size();
  hear_signals(n, [&](const Progress& progress) {
    const BuildOptions options{.threads = threads, .progress = progress};
    model = std::make_shared<Model>(std::move(parts), options, before, moved);
  });
  return model;
}

ModelParts mesh_parts(py::handle vertices, py::handle faces) {
  const Triples points = vertices_in(vertices);
  return parts_of(points, triangles_in(faces, points.count()));
}

ModelParts moved_parts(const Model& before, py::handle vertices, py::handle radii) {
  const Geometry& old = before.geometry();
  const bool is_spheres = before.primitives() > 0 && before.primitives() == old.spheres.size();
  if (!is_spheres && !before.is_one_mesh())
    throw py::value_error("update: expected a World of triangles alone, or of spheres alone");
  if (!is_spheres && !radii.is_none())
    throw py::value_error("radii: expected None in a World of triangles");
  const Triples points = vertices_in(vertices);
  const std::size_t count = is_spheres ? old.spheres.size() : old.triangles.vertex_count();
  if (points.count() != count)
    wrong_value("vertices",
                "as many as before, shape (" + std::to_string(count) + ", 3)",
                text_of(points.full_shape()));
  Geometry same;  // and its looks, which Scene shows
  same.triangles = old.triangles;
  same.objects = old.objects;
  if (!radii.is_none())
    same.spheres = spheres_in(radii, points.shape()).spheres;
  else
    for (const float radius : old.spheres.radius)
      same.spheres.radius.push_back(as_float(radius / before.frame.scale));
  same.spheres.material = old.spheres.material;
  ModelParts parts = parts_of(points, std::move(same));
  parts.scene.materials = before.scene().materials;
  parts.scene.first_vertices = before.scene().first_vertices;
  if (parts.in_double && !parts.scene.first_vertices.empty())
    parts.scene.doubles = doubles_of(points.points());
  return parts;
}

ModelParts sphere_parts(py::handle given, py::handle radii) {
  const Triples centers = rows_in(given, "centers", kMostPrimitives, "fewer than 2^32 - 1 spheres");
  return parts_of(centers, spheres_in(radii, centers.shape()));
}

py::object outside_points(const Model& model, const std::vector<Float3>& points, Shape shape) {
  shape.push_back(3);
  const auto fill = [&](auto array) -> py::object {
    auto* to = array.mutable_data();
    for (const Float3& point : points)
      for (const double x : model.frame.outside(point))
        *to++ = static_cast<std::decay_t<decltype(*to)>>(x);
    return array;
  };
  return model.in_double ? fill(py::array_t<double>(shape)) : fill(py::array_t<float>(shape));
}

py::array_t<float> floats_of(const std::vector<Float3>& all, Shape shape) {
  shape.push_back(3);
  py::array_t<float> array(shape);
  static_assert(sizeof(Float3) == 3 * sizeof(float));
  std::copy_n(reinterpret_cast<const float*>(all.data()), 3 * all.size(), array.mutable_data());
  return array;
}

py::array_t<std::uint8_t> masks_in(py::handle given, const Model& model) {
  const std::string shape = text_of(Shape{py::ssize_t(model.primitives())});
  const py::array_t<std::int64_t> masks = whole_numbers(given, "masks", shape.c_str());
  if (masks.ndim() != 1 || masks.shape(0) != py::ssize_t(model.primitives()))
    wrong_value("masks", "shape " + shape, text_of(shape_of(masks)));
  py::array_t<std::uint8_t> bytes(masks.size());
  std::uint8_t* to = bytes.mutable_data();
  for (py::ssize_t i = 0; i < masks.size(); ++i) {
    const std::int64_t mask = masks.data()[i];
    if (mask < 0 || mask > 255)
      wrong_value(
          "masks", "numbers from 0 to 255", std::to_string(mask) + " at " + std::to_string(i));
    *to++ = std::uint8_t(mask);
  }
  return bytes;
}

}  // namespace grelha::python
