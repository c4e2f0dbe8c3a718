#include "grelha/mesh_check.hpp"
#include "src/hear.hpp"
#include "src/queries.hpp"

namespace grelha::python {
namespace {

/// The number of edges, and the first as an array (k, 3): face, from, to.
py::object found_edges(const Model& model, const Findings<MeshEdge>& found) {
  const std::int64_t first_face = model.first_triangle();
  py::array_t<std::int64_t> first(Shape{py::ssize_t(found.first.size()), 3});
  std::int64_t* to = first.mutable_data();
  for (const MeshEdge& e : found.first)
    for (const std::int64_t number : {e.id - first_face, std::int64_t{e.from}, std::int64_t{e.to}})
      *to++ = number;
  return result_class("Findings")(found.count, first);
}
py::object found_faces(const Model& model, const Findings<std::uint32_t>& found) {
  const std::int64_t first_face = model.first_triangle();
  py::array_t<std::int64_t> first(Shape{py::ssize_t(found.first.size())});
  for (std::size_t i = 0; i < found.first.size(); ++i)
    first.mutable_data()[i] = found.first[i] - first_face;
  return result_class("Findings")(found.count, first);
}

}  // namespace

py::object checked_mesh(const SharedModel& model) {
  hear_signals_beside([model] { check_mesh(model->world()); });
  const MeshCheck& found = check_mesh(model->world());  // which the World keeps
  return result_class("MeshCheck")(found.triangles,
                                   found.vertices,
                                   found.edges,
                                   found_edges(*model, found.open_edges),
                                   found_edges(*model, found.inconsistent_edges),
                                   found_edges(*model, found.nonmanifold_edges),
                                   found_faces(*model, found.duplicate_triangles),
                                   found_faces(*model, found.degenerate_triangles),
                                   found_faces(*model, found.nonfinite_triangles));
}

}  // namespace grelha::python
