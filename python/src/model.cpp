#include "src/model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "grelha/coordinates.hpp"
#include "src/hear.hpp"

namespace grelha::python {
namespace {

constexpr double kLargest = 1e18;  ///< what the kernel computes with
constexpr std::size_t kMostPrimitives = 0xFFFFFFFF;

void expect_usable(const Triples& points, std::size_t i, const char* name) {
  for (std::size_t a = 0; a < 3; ++a)
    if (!(std::abs(points.at(i, a)) <= kLargest))
      wrong_value(name,
                  "finite numbers of at most 1e18",
                  std::to_string(points.at(i, a)) + " at " +
                      text_of(Shape{py::ssize_t(i), py::ssize_t(a)}));
}

void fill_faces(py::handle faces, std::size_t vertices, Triangles& t) {
  const py::array_t<std::int64_t> ids = whole_numbers(faces, "faces", "(m, 3)");
  if (ids.ndim() != 2 || ids.shape(1) != 3)
    wrong_value("faces", "shape (m, 3)", text_of(Shape(ids.shape(), ids.shape() + ids.ndim())));
  const std::size_t count = std::size_t(ids.shape(0));
  if (count >= kMostPrimitives)
    wrong_value("faces", "fewer than 2^32 - 1 triangles", std::to_string(count));
  std::vector<std::uint32_t>* const corners[3] = {&t.a, &t.b, &t.c};
  for (std::size_t k = 0; k < 3; ++k)
    corners[k]->resize(count);
  const std::int64_t* id = ids.data();
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < 3; ++k, ++id) {
      if (*id < 0 || std::size_t(*id) >= vertices)
        wrong_value("faces",
                    "indices of " + std::to_string(vertices) + " vertices",
                    std::to_string(*id) + " at " + text_of(Shape{py::ssize_t(i), py::ssize_t(k)}));
      (*corners[k])[i] = std::uint32_t(*id);
    }
  t.material.resize(count);
}

/// Chooses the frame by the vertices that faces use, and puts all there. Others may be anything.
void fill_vertices(const Triples& vertices, Model& model) {
  Triangles& t = model.scene.geometry.triangles;
  PointBounds bounds;
  std::vector<char> seen(vertices.count());
  for (const std::vector<std::uint32_t>* const corner : {&t.a, &t.b, &t.c})
    for (const std::uint32_t v : *corner) {
      if (std::exchange(seen[v], 1))
        continue;
      expect_usable(vertices, v, "vertices");
      for (std::size_t a = 0; a < 3; ++a)
        bounds.add(a, vertices.at(v, a));
    }
  model.in_double = vertices.in_double();
  if (model.in_double && !t.a.empty())
    model.frame.offset = bounds.offset();
  std::vector<float>* const axes[3] = {&t.x, &t.y, &t.z};
  for (std::size_t a = 0; a < 3; ++a) {
    axes[a]->resize(vertices.count());
    for (std::size_t i = 0; i < vertices.count(); ++i)
      (*axes[a])[i] = model.frame.inside(vertices.at(i, a), a);
  }
}

std::shared_ptr<Model> new_model() {
  auto model = std::make_shared<Model>();
  model->scene.materials.resize(1);
  return model;
}

void expect_vertices(const Triples& vertices) {
  expect_rows(vertices, "vertices");
  if (vertices.count() > kMostPrimitives)
    wrong_value("vertices", "fewer than 2^32 points", std::to_string(vertices.count()));
}

}  // namespace

SharedModel built(std::shared_ptr<Model> model, int threads) {
  hear_signals(model->primitives(), [&](const Progress& progress) {
    model->world = std::make_unique<World>(model->scene,
                                           BuildOptions{.threads = threads, .progress = progress});
  });
  return model;
}

std::shared_ptr<Model> mesh_model(py::handle vertices, py::handle faces) {
  const Triples points(vertices, "vertices");
  expect_vertices(points);
  auto model = new_model();
  fill_faces(faces, points.count(), model->scene.geometry.triangles);
  fill_vertices(points, *model);
  return model;
}

namespace {

std::shared_ptr<Model> moved_mesh(const Triangles& old, const Triples& points) {
  auto model = new_model();
  Triangles& t = model->scene.geometry.triangles;
  t.a = old.a;
  t.b = old.b;
  t.c = old.c;
  t.material = old.material;
  fill_vertices(points, *model);
  return model;
}

/// Radii as given, one for each center.
std::vector<float> radii_in(py::handle given, const Shape& shape) {
  Numbers radii(given, "radii");
  Shape all = shape;
  if (!broadcast(all, radii.shape()) || all != shape)
    wrong_value("radii", "a number or shape " + text_of(shape), text_of(radii.shape()));
  radii.repeat(shape);
  if (radii.shape().empty())
    radii.each.assign(size_of(shape), as_float(radii.all));
  for (std::size_t i = 0; i < radii.each.size(); ++i)
    if (!(radii.each[i] > 0 && double{radii.each[i]} <= kLargest))
      wrong_value("radii",
                  "numbers above 0 of at most 1e18",
                  std::to_string(radii.each[i]) + " at " + std::to_string(i));
  return radii.each;
}

std::shared_ptr<Model> model_of_spheres(const Triples& centers,
                                        const std::vector<float>& radii,
                                        const char* name) {
  auto model = new_model();
  PointBounds bounds;
  for (std::size_t i = 0; i < centers.count(); ++i) {
    expect_usable(centers, i, name);
    for (std::size_t a = 0; a < 3; ++a)
      bounds.add(a, centers.at(i, a));
  }
  model->in_double = centers.in_double();
  if (model->in_double && centers.count() > 0)
    model->frame.offset = bounds.offset();
  Spheres& s = model->scene.geometry.spheres;
  for (const Float3& center : centers.in_frame(model->frame))
    s.add(center, radii[s.size()], 0);
  return model;
}

/// The radii of before, in the caller's units.
std::vector<float> radii_of(const Model& model) {
  std::vector<float> radii = model.scene.geometry.spheres.radius;
  for (float& radius : radii)
    radius = as_float(radius / model.frame.scale);
  return radii;
}

}  // namespace

std::shared_ptr<Model> moved_model(const Model& before, py::handle vertices, py::handle radii) {
  const Geometry& old = before.scene.geometry;
  const bool is_spheres = before.primitives() > 0 && before.primitives() == old.spheres.size();
  if (!is_spheres && !before.is_one_mesh())
    throw py::value_error("update: expected a World of triangles alone, or of spheres alone");
  if (!is_spheres && !radii.is_none())
    throw py::value_error("radii: expected None in a World of triangles");
  const Triples points(vertices, "vertices");
  expect_vertices(points);
  const std::size_t count = is_spheres ? old.spheres.size() : old.triangles.vertex_count();
  if (points.count() != count)
    wrong_value("vertices",
                "as many as before, shape (" + std::to_string(count) + ", 3)",
                text_of(points.full_shape()));
  if (!is_spheres)
    return moved_mesh(old.triangles, points);
  const bool same = radii.is_none();
  return model_of_spheres(
      points, same ? radii_of(before) : radii_in(radii, points.shape()), "vertices");
}

std::shared_ptr<Model> sphere_model(py::handle centers, py::handle radii) {
  const Triples points(centers, "centers");
  expect_rows(points, "centers");
  if (points.count() >= kMostPrimitives)
    wrong_value("centers", "fewer than 2^32 - 1 spheres", std::to_string(points.count()));
  return model_of_spheres(points, radii_in(radii, points.shape()), "centers");
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

py::array_t<std::uint8_t> masks_in(py::handle given, const Model& model) {
  const std::string shape = text_of(Shape{py::ssize_t(model.primitives())});
  const py::array_t<std::int64_t> masks = whole_numbers(given, "masks", shape.c_str());
  if (masks.ndim() != 1 || masks.shape(0) != py::ssize_t(model.primitives()))
    wrong_value(
        "masks", "shape " + shape, text_of(Shape(masks.shape(), masks.shape() + masks.ndim())));
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
