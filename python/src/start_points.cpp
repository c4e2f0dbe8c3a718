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

void expect_on_faces(const std::vector<double>& u, const std::vector<double>& v) {
  constexpr double kRounded = 1e-6;  // of the u and v of hits, which are float32
  for (std::size_t i = 0; i < u.size(); ++i)
    if (!(u[i] >= -kRounded && v[i] >= -kRounded && u[i] + v[i] <= 1 + kRounded))
      wrong_value(
          "u, v",
          "0 or more, together at most 1",
          std::to_string(u[i]) + " and " + std::to_string(v[i]) + " at " + std::to_string(i));
}

/// Points of faces, and the directions in which rays leave them.
struct Starts {
  std::vector<std::uint32_t> face;
  std::vector<double> u, v;
  Triples directions;

  Float3 direction(std::size_t i) const {
    const std::size_t at = directions.shape().empty() ? 0 : i;
    const auto along = [&](std::size_t axis) { return as_float(directions.points().at(at, axis)); };
    return {along(0), along(1), along(2)};
  }
};

std::vector<Float3> origins_of(const Model& model, const Starts& starts, const Progress& progress) {
  constexpr std::size_t kAsk = 256;
  std::vector<Float3> origins(starts.u.size());
  for (std::size_t i = 0; i < origins.size(); ++i) {
    if (i % kAsk == 0 && !progress(double(i) / double(origins.size())))
      throw Stopped();
    const std::uint32_t id = model.first_triangle() + starts.face[i];
    const SurfacePoint surface = surface_at(model.world(), id, starts.u[i], starts.v[i]);
    origins[i] = surface.start(starts.direction(i));
  }
  return origins;
}

}  // namespace

py::object start_points(const Model& model, const StartArguments& given) {
  Triples directions(given.directions, "directions");
  const Wholes face(given.face, "face");
  if (!face)
    wrong_type("face", "whole numbers of shape (...)", given.face);
  Doubles u(given.u, "u");
  Doubles v(given.v, "v");
  Shape shape = directions.shape();
  share(shape, face.shape(), "face");
  share(shape, u.shape(), "u");
  share(shape, v.shape(), "v");
  directions.repeat(shape);
  u.fill(shape);
  v.fill(shape);
  const std::size_t faces = model.geometry().triangles.size();
  const Starts starts{
      face.repeat<std::uint32_t>(shape, "rows of " + std::to_string(faces) + " faces", 0, faces),
      std::move(u.each),
      std::move(v.each),
      std::move(directions)};
  expect_on_faces(starts.u, starts.v);
  std::vector<Float3> origins;
  hear_signals(starts.u.size(),
               [&](const Progress& progress) { origins = origins_of(model, starts, progress); });
  return outside_points(model, origins, shape);
}

}  // namespace grelha::python
