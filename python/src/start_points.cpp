#include <algorithm>
#include <utility>
#include <vector>

#include "grelha/query.hpp"
#include "src/hear.hpp"
#include "src/queries.hpp"

namespace grelha::python {
namespace {

/// Broadcasts a shape with that of one more argument.
void share(Shape& shape, const Shape& with, const char* name) {
  if (!broadcast(shape, with))
    wrong_value(name, "a shape that broadcasts with " + text_of(shape), text_of(with));
}

/// A point of a face by its barycentric coordinates, computed in double.
Float3 point_on(const Triangles& t, std::size_t face, double u, double v) {
  const auto on = [&](const std::vector<float>& x) {
    return as_float((1 - u - v) * double{x[t.a[face]]} + u * double{x[t.b[face]]} +
                    v * double{x[t.c[face]]});
  };
  return {on(t.x), on(t.y), on(t.z)};
}

void expect_on_faces(const std::vector<double>& u, const std::vector<double>& v) {
  constexpr double kRounded = 1e-6;  // of the u and v of hits, which are float32
  for (std::size_t i = 0; i < u.size(); ++i)
    if (!(u[i] >= -kRounded && v[i] >= -kRounded && u[i] + v[i] <= 1 + kRounded))
      wrong_value(
          "u, v",
          "0 or more, together at most 1",
          std::to_string(u[i]) + " and " + std::to_string(v[i]) + " at " + std::to_string(i));
}

std::vector<std::uint32_t> faces_for(const Wholes& given, const Shape& shape, std::size_t count) {
  const py::array_t<std::int64_t> rows = given.repeat(shape);
  std::vector<std::uint32_t> faces(std::size_t(rows.size()));
  std::transform(rows.data(), rows.data() + rows.size(), faces.begin(), [&](std::int64_t row) {
    if (row < 0 || row >= std::int64_t(count))
      wrong_value("face", "rows of " + std::to_string(count) + " faces", std::to_string(row));
    return std::uint32_t(row);
  });
  return faces;
}

/// Points of faces, and the directions in which rays leave them.
struct Starts {
  std::vector<std::uint32_t> face;
  std::vector<double> u, v;
  Triples directions;

  Float3 direction(std::size_t i) const {
    const std::size_t at = directions.shape().empty() ? 0 : i;
    return {as_float(directions.points().at(at, 0)),
            as_float(directions.points().at(at, 1)),
            as_float(directions.points().at(at, 2))};
  }
};

std::vector<Float3> origins_of(const Model& model, const Starts& starts, const Progress& progress) {
  constexpr std::size_t kAsk = 256;
  std::vector<Float3> origins(starts.u.size());
  for (std::size_t i = 0; i < origins.size(); ++i) {
    if (i % kAsk == 0 && !progress(double(i) / double(origins.size())))
      throw Stopped();
    const Float3 point =
        point_on(model.geometry().triangles, starts.face[i], starts.u[i], starts.v[i]);
    const SurfacePoint surface =
        surface_at(model.world(), model.first_triangle() + starts.face[i], point);
    origins[i] = surface.offset_origin(starts.direction(i));
  }
  return origins;
}

}  // namespace

py::object start_points(const Model& model, const StartArguments& given) {
  Triples directions(given.directions, "directions");
  const Wholes face(given.face, "face");
  if (!face)
    wrong_type("face", "whole numbers of shape (...)", given.face);
  const Doubles u(given.u, "u");
  const Doubles v(given.v, "v");
  Shape shape = directions.shape();
  share(shape, face.shape(), "face");
  share(shape, u.shape(), "u");
  share(shape, v.shape(), "v");
  directions.repeat(shape);
  const Starts starts{faces_for(face, shape, model.geometry().triangles.size()),
                      u.repeat(shape),
                      v.repeat(shape),
                      std::move(directions)};
  expect_on_faces(starts.u, starts.v);
  std::vector<Float3> origins;
  hear_signals(starts.u.size(),
               [&](const Progress& progress) { origins = origins_of(model, starts, progress); });
  return outside_points(model, origins, shape);
}

}  // namespace grelha::python
