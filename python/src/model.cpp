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

std::shared_ptr<Model> moved_model(const Model& before, py::handle vertices) {
  if (!before.is_one_mesh())
    throw py::value_error("update: expected a World of triangles alone");
  const Triples points(vertices, "vertices");
  expect_vertices(points);
  const Triangles& old = before.scene.geometry.triangles;
  if (points.count() != old.vertex_count())
    wrong_value("vertices",
                "as many as before, shape (" + std::to_string(old.vertex_count()) + ", 3)",
                text_of(points.full_shape()));
  auto model = new_model();
  Triangles& t = model->scene.geometry.triangles;
  t.a = old.a;
  t.b = old.b;
  t.c = old.c;
  t.material = old.material;
  fill_vertices(points, *model);
  return model;
}

std::shared_ptr<Model> sphere_model(py::handle centers, py::handle radii) {
  const Triples points(centers, "centers");
  expect_rows(points, "centers");
  if (points.count() >= kMostPrimitives)
    wrong_value("centers", "fewer than 2^32 - 1 spheres", std::to_string(points.count()));
  const Numbers sizes = numbers_for(radii, "radii", points.shape());
  auto model = new_model();
  Spheres& s = model->scene.geometry.spheres;
  PointBounds bounds;
  for (std::size_t i = 0; i < points.count(); ++i) {
    expect_usable(points, i, "centers");
    for (std::size_t a = 0; a < 3; ++a)
      bounds.add(a, points.at(i, a));
  }
  model->in_double = points.in_double();
  if (model->in_double && points.count() > 0)
    model->frame.offset = bounds.offset();
  for (const Float3& center : points.in_frame(model->frame)) {
    const float radius = sizes.each.empty() ? float(sizes.all) : sizes.each[s.size()];
    if (!(radius > 0 && double{radius} <= kLargest))
      wrong_value("radii",
                  "numbers above 0 of at most 1e18",
                  std::to_string(radius) + " at " + std::to_string(s.size()));
    s.add(center, radius, 0);
  }
  return model;
}

}  // namespace grelha::python
