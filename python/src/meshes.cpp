#include "src/meshes.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace grelha::python {
namespace {

/// One mesh among the arrays of a model.
struct MeshRange {
  Object faces;
  std::uint32_t first_vertex, vertex_count;
};

MeshRange range_of(const Model& model, std::size_t mesh) {
  const Triangles& t = model.geometry().triangles;
  const std::vector<std::uint32_t>& first = model.first_vertices;
  if (first.empty())
    return {{0, std::uint32_t(t.size())}, 0, std::uint32_t(t.vertex_count())};
  return {model.geometry().objects[mesh], first[mesh], first[mesh + 1] - first[mesh]};
}

/// The faces of one mesh, as indices of its own vertices.
Geometry faces_of(const Triangles& all, const MeshRange& mesh) {
  const auto own = [&](const std::vector<std::uint32_t>& corner) {
    const auto from = corner.begin() + mesh.faces.first_triangle;
    std::vector<std::uint32_t> indices(from, from + mesh.faces.triangle_count);
    for (std::uint32_t& i : indices)
      i -= mesh.first_vertex;
    return indices;
  };
  Geometry faces;
  faces.triangles.a = own(all.a);
  faces.triangles.b = own(all.b);
  faces.triangles.c = own(all.c);
  return faces;
}

/// Ids at which meshes begin, and where the last ends.
std::vector<std::int64_t> begins_of(const Model& model) {
  std::vector<std::int64_t> begins;
  for (std::size_t i = 0; i < mesh_count(model); ++i)
    begins.push_back(model.first_triangle() + range_of(model, i).faces.first_triangle);
  begins.push_back(model.first_triangle() + std::int64_t(model.geometry().triangles.size()));
  return begins;
}

}  // namespace

ModelParts joined_parts(py::handle vertices, py::handle faces, py::handle given) {
  const py::array_t<std::int64_t> counts = whole_numbers(given, "counts", "(meshes, 2)");
  ModelParts parts = mesh_parts(vertices, faces);
  parts.first_vertices = {0};
  std::uint32_t first_face = 0;
  for (py::ssize_t i = 0; i < counts.shape(0); ++i) {
    const auto count = std::uint32_t(counts.at(i, 1));
    parts.scene.geometry.objects.push_back({first_face, count});
    first_face += count;
    parts.first_vertices.push_back(parts.first_vertices.back() + std::uint32_t(counts.at(i, 0)));
  }
  return parts;
}

SharedModel mesh_moved(const Model& before, py::handle mesh, py::handle vertices, int threads) {
  if (!before.is_one_mesh() || mesh_count(before) == 0)
    throw py::value_error("update_mesh: expected a World of triangles alone");
  const int which = whole_number_in(mesh, "mesh", 0, int(mesh_count(before)) - 1);
  const MeshRange range = range_of(before, std::size_t(which));
  const Triples points = vertices_in(vertices);
  if (points.count() != range.vertex_count)
    wrong_value("vertices",
                "as many as before, shape (" + std::to_string(range.vertex_count) + ", 3)",
                text_of(points.full_shape()));
  parts_of(points, faces_of(before.geometry().triangles, range));  // to refuse what is not finite
  ModelParts parts{before.scene(), before.frame.scale, before.in_double, before.first_vertices};
  Triangles& t = parts.scene.geometry.triangles;
  std::size_t at = range.first_vertex;
  for (const Float3& p : points.in_frame(before.frame)) {
    t.x[at] = p.x;
    t.y[at] = p.y;
    t.z[at++] = p.z;
  }
  return built(std::move(parts), threads, &before, {&range.faces, 1});
}

std::size_t mesh_count(const Model& model) {
  return model.first_vertices.empty() ? 1 : model.first_vertices.size() - 1;
}

py::tuple mesh_of(const Model& model, py::handle given) {
  const py::array_t<std::int64_t> ids = whole_numbers(given, "ids", "(...)");
  const std::vector<std::int64_t> begins = begins_of(model);
  py::array_t<std::int64_t> mesh(shape_of(ids)), face(shape_of(ids));
  std::int64_t* to_mesh = mesh.mutable_data();
  std::int64_t* to_face = face.mutable_data();
  for (const std::int64_t id : std::span(ids.data(), std::size_t(ids.size()))) {
    if (id < -1 || id >= std::int64_t(model.primitives()))
      wrong_value("ids",
                  "-1, or ids of " + std::to_string(model.primitives()) + " primitives",
                  std::to_string(id));
    const auto next = std::upper_bound(begins.begin(), begins.end(), id);
    const bool is_face = next != begins.begin() && next != begins.end();
    *to_mesh++ = is_face ? next - begins.begin() - 1 : -1;
    *to_face++ = is_face ? id - next[-1] : -1;
  }
  if (ids.ndim() == 0)
    return py::make_tuple(*mesh.data(), *face.data());
  return py::make_tuple(mesh, face);
}

}  // namespace grelha::python
