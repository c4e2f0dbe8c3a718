#include "src/meshes.hpp"

#include <array>
#include <list>
#include <string>
#include <vector>

namespace grelha::python {
namespace {

/// The faces of one mesh, as indices of its own vertices.
Geometry faces_of(const Triangles& all, const MeshRange& mesh) {
  const auto own = [&](const std::vector<std::uint32_t>& corner) {
    const auto from = corner.begin() + mesh.triangles.first_triangle;
    std::vector<std::uint32_t> indices(from, from + mesh.triangles.triangle_count);
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

/// The number of a mesh of a World of triangles alone, which `method` asks for.
std::size_t mesh_in(py::handle mesh, const Model& model, const char* method) {
  const int count = int(mesh_count(model.scene()));
  if (!model.is_one_mesh() || count == 0)
    throw py::value_error(method + std::string(": expected a World of triangles alone"));
  return std::size_t(whole_number_in(mesh, "mesh", 0, count - 1));
}

/// Vertices of one mesh as move_mesh() and add_mesh() take them, among those of a model before.
class VerticesAmong {
 public:
  VerticesAmong(const Triples& given, const Model& before, bool in_double) {
    if (before.frame.scale != 1) {  // of a file: they count from its frame, which stays
      in_frame_ = given.in_frame(before.frame);
      array = PointArray(std::span<const Float3>(in_frame_));
      array.name = "vertices";
    } else if (in_double) {  // floats too count from 0 for a caller
      doubles_ = doubles_of(given.points());
      array = PointArray(doubles_.data(), 3 * sizeof(double), given.count(), "vertices");
    } else {
      array = given.points();
    }
  }
  VerticesAmong(const VerticesAmong&) = delete;

  PointArray array;

 private:
  std::vector<Float3> in_frame_;
  std::vector<double> doubles_;
};

/// Whether a model with more vertices has them in double: what is of a file keeps its frame.
bool becomes_double(const Model& before, const Triples& given) {
  return before.in_double || (before.frame.scale == 1 && given.in_double());
}

constexpr std::size_t kMostInPlace = std::size_t{1} << 15;  ///< faces: built in milliseconds
constexpr std::size_t kMostGrids = 16;                      ///< meshes, each with a grid
constexpr std::size_t kMostShared = std::size_t{1} << 20;   ///< faces that may share one more grid

/// The model itself where it may change: no query and no Scene shares it, floats keep its frame,
/// and so little is built that Python's lock is kept meanwhile. Null: a changed copy is due.
Model* model_to_change(const SharedModel& model, std::size_t faces, bool in_double) {
  const OffsetScene& scene = model->scene();
  const bool is_quick = faces <= kMostInPlace && (mesh_count(scene) <= kMostGrids ||
                                                  scene.geometry.triangles.size() <= kMostShared);
  const bool is_sole = model.use_count() == 1 && !in_double;
  return is_sole && is_quick ? const_cast<Model*>(model.get()) : nullptr;
}

/// Vertices that may be those of a mesh. Throws ValueError.
Triples vertices_for(const Model& before, std::size_t mesh, py::handle given) {
  const MeshRange range = mesh_range(before.scene(), mesh);
  Triples points = vertices_in(given);
  if (points.count() != range.vertex_count)
    wrong_value("vertices",
                "as many as before, shape (" + std::to_string(range.vertex_count) + ", 3)",
                text_of(points.full_shape()));
  parts_of(points, faces_of(before.geometry().triangles, range));  // to refuse what is not finite
  return points;
}

}  // namespace

ModelParts joined_parts(py::handle vertices, py::handle faces, py::handle given) {
  const py::array_t<std::int64_t> counts = whole_numbers(given, "counts", "(meshes, 2)");
  ModelParts parts = mesh_parts(vertices, faces);
  if (parts.in_double)
    parts.scene.doubles = doubles_of(vertices_in(vertices).points());
  parts.scene.first_vertices = {0};
  std::uint32_t first_face = 0;
  for (py::ssize_t i = 0; i < counts.shape(0); ++i) {
    const auto count = std::uint32_t(counts.at(i, 1));
    parts.scene.geometry.objects.push_back({first_face, count});
    first_face += count;
    parts.scene.first_vertices.push_back(parts.scene.first_vertices.back() +
                                         std::uint32_t(counts.at(i, 0)));
  }
  return parts;
}

SharedModel meshes_moved(const SharedModel& model,
                         const py::list& given,
                         const char* method,
                         int threads) {
  const Model& before = *model;
  std::size_t faces = 0;
  std::vector<std::size_t> numbers;
  std::vector<Triples> vertices;
  bool in_double = before.in_double;
  for (const py::handle pair : given) {
    const auto move = py::reinterpret_borrow<py::tuple>(pair);
    numbers.push_back(mesh_in(move[0], before, method));
    faces += mesh_range(before.scene(), numbers.back()).triangles.triangle_count;
    vertices.push_back(vertices_for(before, numbers.back(), move[1]));
    in_double |= becomes_double(before, vertices.back());
  }
  std::list<VerticesAmong> placed;
  std::vector<MeshMove> moves;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    moves.push_back({numbers[i], placed.emplace_back(vertices[i], before, in_double).array});
  if (Model* const same = model_to_change(model, faces, in_double)) {
    move_meshes(same->owner, moves, {.threads = threads});
    return model;
  }
  ModelParts parts{before.scene(), before.frame.scale, in_double};
  const std::vector<Object> moved = move_meshes(parts.scene, moves);
  return built(std::move(parts), threads, &before, moved);
}

SharedModel mesh_shown(const SharedModel& model, py::handle mesh, bool visible, int threads) {
  const Model& before = *model;
  const std::size_t number = mesh_in(mesh, before, "set_visible");
  const std::size_t faces = mesh_range(before.scene(), number).triangles.triangle_count;
  if (Model* const same = model_to_change(model, faces, false)) {
    show_mesh(same->owner, number, visible, {.threads = threads});
    return model;
  }
  ModelParts parts{before.scene(), before.frame.scale, before.in_double};
  show_mesh(parts.scene, number, visible);
  return built(std::move(parts), threads, &before);
}

SharedModel mesh_added(const SharedModel& model,
                       py::handle vertices,
                       py::handle faces,
                       int threads) {
  const Model& before = *model;
  if (!before.is_one_mesh())
    throw py::value_error("add_mesh: expected a World of triangles alone");
  const ModelParts added = mesh_parts(vertices, faces);
  const Triples points = vertices_in(vertices);
  const bool in_double = becomes_double(before, points);
  const VerticesAmong placed(points, before, in_double);
  const Triangles& t = added.scene.geometry.triangles;
  std::vector<std::array<std::uint32_t, 3>> corners;
  for (std::size_t i = 0; i < t.size(); ++i)
    corners.push_back({t.a[i], t.b[i], t.c[i]});
  if (Model* const same = model_to_change(model, corners.size(), in_double)) {
    add_mesh(same->owner, {placed.array, corners}, {.threads = threads});
    return model;
  }
  ModelParts parts{before.scene(), before.frame.scale, in_double};
  const Object moved = add_mesh(parts.scene, {placed.array, corners});
  return built(std::move(parts), threads, &before, {&moved, 1});
}

SharedModel mesh_removed(const Model& before, py::handle mesh, int threads) {
  const std::size_t number = mesh_in(mesh, before, "remove_mesh");
  ModelParts parts{before.scene(), before.frame.scale, before.in_double};
  const Object moved = remove_mesh(parts.scene, number);
  return built(std::move(parts), threads, &before, {&moved, 1});
}

bool mesh_is_visible(const Model& model, py::handle mesh) {
  return mesh_range(model.scene(), mesh_in(mesh, model, "is_visible")).triangles.visible;
}

py::tuple mesh_of(const Model& model, py::handle given) {
  const py::array_t<std::int64_t> ids = whole_numbers(given, "ids", "(...)");
  py::array_t<std::int64_t> mesh(shape_of(ids)), face(shape_of(ids));
  std::int64_t* to_mesh = mesh.mutable_data();
  std::int64_t* to_face = face.mutable_data();
  for (const std::int64_t id : std::span(ids.data(), std::size_t(ids.size()))) {
    if (id < -1 || id >= std::int64_t(model.primitives()))
      wrong_value("ids",
                  "-1, or ids of " + std::to_string(model.primitives()) + " primitives",
                  std::to_string(id));
    const MeshFace found = mesh_face(model.scene(), std::uint32_t(id));  // -1: kNoPrimitive
    const bool is_face = found.mesh != kNoPrimitive;
    *to_mesh++ = is_face ? std::int64_t(found.mesh) : -1;
    *to_face++ = is_face ? std::int64_t(found.face) : -1;
  }
  if (ids.ndim() == 0)
    return py::make_tuple(*mesh.data(), *face.data());
  return py::make_tuple(mesh, face);
}

}  // namespace grelha::python
