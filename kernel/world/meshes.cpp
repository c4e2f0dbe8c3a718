#include "grelha/meshes.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "kernel/world/used_points.hpp"
#include "kernel/world/world_impl.hpp"

namespace grelha {
namespace {

constexpr std::size_t kMostRows = 0xFFFFFFFE;

/// A mesh by itself, checked.
OffsetScene checked(const MeshArrays& mesh) {
  return scene_of(mesh.vertices, triangles_of<std::uint32_t>(mesh.faces, mesh.vertices.count));
}

/// The same as mesh `number` of several.
OffsetScene checked(const MeshArrays& mesh, std::size_t number) {
  const std::string name = "mesh " + std::to_string(number) + ": ";
  try {
    return checked(mesh);
  } catch (const BadNumber& bad) {
    BadNumber named(name + bad.what());
    named.found = bad.found;
    named.row = bad.row;
    named.column = bad.column;
    throw named;
  } catch (const std::invalid_argument& bad) {
    throw std::invalid_argument(name + bad.what());
  }
}

/// Throws std::invalid_argument if ids or indices would not hold what a scene would have.
void expect_room(std::size_t vertices, std::size_t triangles) {
  if (vertices > kMostRows || triangles > kMostRows)
    throw std::invalid_argument("meshes: expected at most " + std::to_string(kMostRows) +
                                " vertices and triangles in all, found " +
                                std::to_string(std::max(vertices, triangles)));
}

/// Appends the triangles of a mesh whose vertices are to follow.
Object append_triangles(OffsetScene& scene, const Triangles& mesh, std::size_t vertices) {
  Triangles& all = scene.geometry.triangles;
  const std::uint32_t first = scene.first_vertices.back();
  expect_room(first + vertices, all.size() + mesh.size());
  const Object added{static_cast<std::uint32_t>(all.size()),
                     static_cast<std::uint32_t>(mesh.size())};
  const auto append = [first](std::vector<std::uint32_t>& to,
                              const std::vector<std::uint32_t>& corner) {
    for (const std::uint32_t vertex : corner)
      to.push_back(first + vertex);
  };
  append(all.a, mesh.a);
  append(all.b, mesh.b);
  append(all.c, mesh.c);
  scene.geometry.objects.push_back(added);
  scene.first_vertices.push_back(first + static_cast<std::uint32_t>(vertices));
  return added;
}

/// Vertices of all meshes, one after the other.
template <class Number>
std::vector<Number> joined_vertices(std::span<const MeshArrays> meshes) {
  std::vector<Number> joined;
  for (const MeshArrays& mesh : meshes)
    for (std::size_t i = 0; i < mesh.vertices.count; ++i)
      for (std::size_t a = 0; a < 3; ++a)
        joined.push_back(static_cast<Number>(mesh.vertices.at(i, a)));
  return joined;
}

/// The scene with these vertices.
template <class Number>
OffsetScene with_vertices(OffsetScene scene, const std::vector<Number>& vertices) {
  const PointArray points(vertices.data(), 3 * sizeof(Number), vertices.size() / 3, "vertices");
  OffsetScene placed = scene_of(points, std::move(scene.geometry));
  placed.first_vertices = std::move(scene.first_vertices);
  return placed;
}

/// Makes all of a scene its first mesh, unless it has meshes.
void name_meshes(OffsetScene& scene) {
  if (!scene.first_vertices.empty())
    return;
  const Triangles& t = scene.geometry.triangles;
  expect_room(t.vertex_count(), t.size());
  scene.geometry.objects = {{0, static_cast<std::uint32_t>(t.size())}};
  scene.first_vertices = {0, static_cast<std::uint32_t>(t.vertex_count())};
}

std::size_t first_triangle_id(const OffsetScene& scene) {
  return scene.geometry.planes.size() + scene.geometry.spheres.size();
}

/// Triangles of one mesh, by numbers of its own vertices.
Geometry triangles_of_mesh(const OffsetScene& scene, const MeshRange& mesh) {
  Geometry own;
  const auto copy = [&](const std::vector<std::uint32_t>& corner, std::vector<std::uint32_t>& to) {
    for (std::size_t i = 0; i < mesh.triangles.triangle_count; ++i)
      to.push_back(corner[mesh.triangles.first_triangle + i] - mesh.first_vertex);
  };
  const Triangles& all = scene.geometry.triangles;
  copy(all.a, own.triangles.a);
  copy(all.b, own.triangles.b);
  copy(all.c, own.triangles.c);
  return own;
}

constexpr std::ptrdiff_t kThreeDoubles = 3 * sizeof(double);

/// All vertices as the caller gave them: what floats lost is needed where the offset changes.
std::vector<double> all_doubles(const OffsetScene& scene) {
  const Triangles& t = scene.geometry.triangles;
  std::vector<double> all;
  for (std::size_t i = 0; i < t.vertex_count(); ++i)
    for (const double x : {scene.offset[0] + double{t.x[i]},
                           scene.offset[1] + double{t.y[i]},
                           scene.offset[2] + double{t.z[i]}})
      all.push_back(x);
  return all;
}

/// Returns whether the offset changed.
bool choose_offset(OffsetScene& scene) {
  Triangles& t = scene.geometry.triangles;
  const PointArray all(scene.doubles.data(), kThreeDoubles, t.vertex_count(), "vertices");
  const auto offset = used_bounds(all, scene.geometry).offset(scene.offset);
  if (offset == scene.offset)
    return false;
  scene.offset = offset;
  std::vector<float>* const axes[3] = {&t.x, &t.y, &t.z};
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t i = 0; i < all.count; ++i)
      (*axes[a])[i] = static_cast<float>(all.at(i, a) - offset[a]);
  return true;
}

/// Writes vertices from a place on, in the scene's frame.
void put_vertices(OffsetScene& scene, std::size_t first, const PointArray& vertices) {
  Triangles& t = scene.geometry.triangles;
  if (vertices.in_double && scene.doubles.empty())
    scene.doubles = all_doubles(scene);
  scene.doubles.resize(scene.doubles.empty() ? 0 : 3 * t.vertex_count());
  std::vector<float>* const axes[3] = {&t.x, &t.y, &t.z};
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t i = 0; i < vertices.count; ++i) {
      const double given = vertices.at(i, a), offset = scene.offset[a];
      (*axes[a])[first + i] = static_cast<float>(vertices.in_double ? given - offset : given);
      if (!scene.doubles.empty())
        scene.doubles[3 * (first + i) + a] = vertices.in_double ? given : given + offset;
    }
}

Object all_triangles(const OffsetScene& scene) {
  return {0, static_cast<std::uint32_t>(scene.geometry.triangles.size())};
}

void expect_bare_triangles(const OffsetScene& scene) {
  const Geometry& g = scene.geometry;
  if (first_triangle_id(scene) > 0 || g.cones.size() > 0 || !g.triangles.material.empty() ||
      !g.triangles.nx.empty() || !g.triangles.red.empty())
    throw std::invalid_argument(
        "scene: expected triangles alone, without materials, normals and colours");
}

/// The range of a mesh that can be moved so.
MeshRange checked_range(const OffsetScene& scene, const MeshMove& move) {
  const MeshRange range = mesh_range(scene, move.mesh);
  if (move.vertices.count != range.vertex_count)
    throw std::invalid_argument("count: expected as many vertices as before, " +
                                std::to_string(range.vertex_count) + ", found " +
                                std::to_string(move.vertices.count));
  scene_of(move.vertices, triangles_of_mesh(scene, range));  // to refuse what is not finite
  return range;
}

void expect_different(std::span<const MeshMove> moves) {
  std::set<std::size_t> meshes;
  for (const MeshMove& move : moves)
    if (!meshes.insert(move.mesh).second)
      throw std::invalid_argument("mesh: expected each once, found " + std::to_string(move.mesh) +
                                  " twice");
}

template <class Element>
void erase(std::vector<Element>& array, std::size_t first, std::size_t count) {
  const auto from = array.begin() + static_cast<std::ptrdiff_t>(first);
  array.erase(from, from + static_cast<std::ptrdiff_t>(count));
}

}  // namespace

OffsetScene scene_of(std::span<const MeshArrays> meshes) {
  OffsetScene scene;
  scene.first_vertices = {0};
  bool in_double = false;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    append_triangles(scene, checked(meshes[i], i).geometry.triangles, meshes[i].vertices.count);
    in_double |= meshes[i].vertices.in_double;
  }
  if (!in_double)
    return with_vertices(std::move(scene), joined_vertices<float>(meshes));
  std::vector<double> all = joined_vertices<double>(meshes);
  scene = with_vertices(std::move(scene), all);
  scene.doubles = std::move(all);
  return scene;
}

std::size_t mesh_count(const OffsetScene& scene) {
  return scene.first_vertices.empty() ? 1 : scene.first_vertices.size() - 1;
}

MeshFace mesh_face(const OffsetScene& scene, std::uint32_t id) {
  const std::size_t first = first_triangle_id(scene);
  if (id < first || id - first >= scene.geometry.triangles.size())
    return {};
  const auto triangle = static_cast<std::uint32_t>(id - first);
  if (scene.first_vertices.empty())
    return {0, triangle};
  const std::vector<Object>& meshes = scene.geometry.objects;
  const auto next = std::ranges::upper_bound(meshes, triangle, {}, &Object::first_triangle);
  const auto mesh = next - 1;  // the last that begins there: those before are empty
  return {static_cast<std::uint32_t>(mesh - meshes.begin()), triangle - mesh->first_triangle};
}

MeshRange mesh_range(const OffsetScene& scene, std::size_t mesh) {
  if (mesh >= mesh_count(scene))
    throw std::invalid_argument("mesh: expected less than " + std::to_string(mesh_count(scene)) +
                                ", found " + std::to_string(mesh));
  const Triangles& t = scene.geometry.triangles;
  const std::vector<std::uint32_t>& first = scene.first_vertices;
  if (first.empty())
    return {
        {0, static_cast<std::uint32_t>(t.size())}, 0, static_cast<std::uint32_t>(t.vertex_count())};
  return {scene.geometry.objects[mesh], first[mesh], first[mesh + 1] - first[mesh]};
}

Object move_mesh(OffsetScene& scene, std::size_t mesh, const PointArray& vertices) {
  const MeshMove move{mesh, vertices};
  return move_meshes(scene, {&move, 1}).front();
}

std::vector<Object> move_meshes(OffsetScene& scene, std::span<const MeshMove> moves) {
  std::vector<MeshRange> ranges;
  for (const MeshMove& move : moves)
    ranges.push_back(checked_range(scene, move));
  expect_different(moves);
  std::vector<Object> moved;
  bool in_double = false;
  for (std::size_t i = 0; i < moves.size(); ++i) {
    put_vertices(scene, ranges[i].first_vertex, moves[i].vertices);
    moved.push_back(ranges[i].triangles);
    in_double |= moves[i].vertices.in_double;
  }
  if (in_double && choose_offset(scene))
    moved = {all_triangles(scene)};
  return moved;
}

void show_mesh(OffsetScene& scene, std::size_t mesh, bool visible) {
  mesh_range(scene, mesh);  // to refuse what is none
  name_meshes(scene);
  scene.geometry.objects[mesh].visible = visible;
}

Object add_mesh(OffsetScene& scene, const MeshArrays& mesh) {
  expect_bare_triangles(scene);
  const OffsetScene own = checked(mesh);
  name_meshes(scene);
  const std::size_t first = scene.first_vertices.back();
  const Object added = append_triangles(scene, own.geometry.triangles, mesh.vertices.count);
  Triangles& t = scene.geometry.triangles;
  for (std::vector<float>* const axis : {&t.x, &t.y, &t.z})
    axis->resize(first + mesh.vertices.count);
  put_vertices(scene, first, mesh.vertices);
  return mesh.vertices.in_double && choose_offset(scene) ? all_triangles(scene) : added;
}

Object remove_mesh(OffsetScene& scene, std::size_t mesh) {
  expect_bare_triangles(scene);
  const MeshRange range = mesh_range(scene, mesh);
  name_meshes(scene);
  Triangles& t = scene.geometry.triangles;
  const Object& gone = range.triangles;
  for (std::vector<std::uint32_t>* const corner : {&t.a, &t.b, &t.c}) {
    erase(*corner, gone.first_triangle, gone.triangle_count);
    for (std::size_t i = gone.first_triangle; i < corner->size(); ++i)
      (*corner)[i] -= range.vertex_count;
  }
  for (std::vector<float>* const axis : {&t.x, &t.y, &t.z})
    erase(*axis, range.first_vertex, range.vertex_count);
  if (!scene.doubles.empty())
    erase(scene.doubles, 3 * std::size_t{range.first_vertex}, 3 * std::size_t{range.vertex_count});
  erase(scene.geometry.objects, mesh, 1);
  erase(scene.first_vertices, mesh, 1);
  for (std::size_t i = mesh; i < scene.first_vertices.size(); ++i)
    scene.first_vertices[i] -= range.vertex_count;
  for (std::size_t i = mesh; i < scene.geometry.objects.size(); ++i)
    scene.geometry.objects[i].first_triangle -= gone.triangle_count;
  if (!scene.doubles.empty() && choose_offset(scene))
    return all_triangles(scene);
  return {gone.first_triangle, static_cast<std::uint32_t>(t.size()) - gone.first_triangle};
}

/// A change of the scene that a World refers to, in place. Without commit() it is undone.
class MeshEdit {
 public:
  explicit MeshEdit(OwningWorld& owner) : scene(owner.scene_), owner_(owner) {}
  MeshEdit(const MeshEdit&) = delete;
  ~MeshEdit() {
    if (undo)
      undo();
  }

  /// Builds anew what moved.
  void commit(const BuildOptions& options, std::span<const Object> moved) {
    owner_.world_.update(scene, options, moved);
    undo = nullptr;
    if (!owner_.masks_.empty())
      owner_.masks_.resize(owner_.world_.impl().primitives.ids.end(), 255);
  }

  /// Takes a scene with other triangles, and masks of theirs.
  void replace(OffsetScene next,
               std::vector<std::uint8_t> masks,
               const BuildOptions& options,
               const Object& moved) {
    owner_.replace(std::move(next), options, {&moved, 1});
    owner_.masks_ = std::move(masks);
  }

  OffsetScene& scene;
  std::function<void()> undo;

 private:
  OwningWorld& owner_;
};

namespace {

/// Coordinates of meshes before they move.
class MovedVertices {
 public:
  MovedVertices(const OffsetScene& scene, std::span<const MeshMove> moves) {
    for (const MeshMove& move : moves) {
      const MeshRange range = mesh_range(scene, move.mesh);
      const Triangles& t = scene.geometry.triangles;
      for (const std::vector<float>* const axis : {&t.x, &t.y, &t.z}) {
        const auto from = axis->begin() + range.first_vertex;
        before_.emplace_back(from, from + range.vertex_count);
      }
      first_.push_back(range.first_vertex);
    }
  }
  void restore(OffsetScene& scene) const {
    Triangles& t = scene.geometry.triangles;
    std::vector<float>* const axes[3] = {&t.x, &t.y, &t.z};
    for (std::size_t i = 0; i < before_.size(); ++i)
      std::ranges::copy(before_[i], axes[i % 3]->begin() + first_[i / 3]);
  }

 private:
  std::vector<std::vector<float>> before_;  ///< x, y and z of each
  std::vector<std::uint32_t> first_;
};

/// Gives arrays room for more, mostly for as much again. A World may go on reading what they had:
/// it stays in memory as long as this, and undo() gives it back.
class GrownArrays {
 public:
  template <class Element>
  void grow(std::vector<Element>& array, std::size_t more) {
    auto before = std::make_shared<std::vector<Element>>();
    const std::size_t size = array.size();
    if (size + more > array.capacity()) {
      std::vector<Element> larger;
      larger.reserve(std::max(size + more, 2 * size));
      larger.assign(array.begin(), array.end());
      *before = std::exchange(array, std::move(larger));
    }
    undo_.push_back([&array, before, size] {
      if (before->empty())
        array.resize(size);
      else
        array.swap(*before);
    });
  }
  void undo() const {
    for (const auto& one : undo_)
      one();
  }

 private:
  std::vector<std::function<void()>> undo_;
};

bool any_in_double(std::span<const MeshMove> moves) {
  return std::ranges::any_of(moves, [](const MeshMove& move) { return move.vertices.in_double; });
}

}  // namespace

void move_meshes(OwningWorld& world, std::span<const MeshMove> moves, const BuildOptions& options) {
  if (any_in_double(moves) || !world.scene().doubles.empty()) {  // all may be rounded anew
    OffsetScene scene = world.scene();
    const std::vector<Object> moved = move_meshes(scene, moves);
    world.replace(std::move(scene), options, moved);
    return;
  }
  const MovedVertices before(world.scene(), moves);
  MeshEdit edit(world);
  edit.undo = [&] { before.restore(edit.scene); };
  edit.commit(options, move_meshes(edit.scene, moves));
}

void show_mesh(OwningWorld& world, std::size_t mesh, bool visible, const BuildOptions& options) {
  const bool before = mesh_range(world.scene(), mesh).triangles.visible;
  MeshEdit edit(world);
  edit.undo = [&] { show_mesh(edit.scene, mesh, before); };
  show_mesh(edit.scene, mesh, visible);
  edit.commit(options, {});
}

void add_mesh(OwningWorld& world, const MeshArrays& mesh, const BuildOptions& options) {
  if (mesh.vertices.in_double || !world.scene().doubles.empty()) {  // all may be rounded anew
    OffsetScene scene = world.scene();
    const Object moved = add_mesh(scene, mesh);
    world.replace(std::move(scene), options, {&moved, 1});
    return;
  }
  GrownArrays grown;
  MeshEdit edit(world);
  Triangles& t = edit.scene.geometry.triangles;
  edit.undo = [&] { grown.undo(); };
  for (std::vector<float>* const axis : {&t.x, &t.y, &t.z})
    grown.grow(*axis, mesh.vertices.count);
  for (std::vector<std::uint32_t>* const corner : {&t.a, &t.b, &t.c})
    grown.grow(*corner, mesh.faces.size());
  grown.grow(edit.scene.geometry.objects, 2);
  grown.grow(edit.scene.first_vertices, 3);
  const Object added = add_mesh(edit.scene, mesh);
  edit.commit(options, {&added, 1});
}

void remove_mesh(OwningWorld& world, std::size_t mesh, const BuildOptions& options) {
  const MeshRange gone = mesh_range(world.scene(), mesh);
  std::vector<std::uint8_t> masks(world.masks().begin(), world.masks().end());
  if (!masks.empty())
    erase(masks, gone.triangles.first_triangle, gone.triangles.triangle_count);
  OffsetScene scene = world.scene();
  const Object behind = remove_mesh(scene, mesh);
  MeshEdit(world).replace(std::move(scene), std::move(masks), options, behind);
}

}  // namespace grelha
