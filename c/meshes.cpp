#include "grelha/meshes.hpp"

#include <span>
#include <string>
#include <vector>

#include "c/world.hpp"

namespace grelha::c {
namespace {

/// The arrays of a mesh. Throws std::invalid_argument and TooMany.
MeshArrays arrays_of(const grelha_mesh& mesh) {
  expect_at_most(mesh.triangle_count, kMostPrimitives, "triangle_count");
  expect_at_most(mesh.vertex_count, kMostVertices, "vertex_count");
  if (mesh.triangle_count > 0)
    expect_there(mesh.indices, "indices");
  if (mesh.vertices && mesh.doubles)
    throw std::invalid_argument("vertices: expected floats or doubles, found both");
  const auto* const faces = reinterpret_cast<const std::array<std::uint32_t, 3>*>(mesh.indices);
  return {mesh.doubles ? PointArray(mesh.doubles, mesh.stride, mesh.vertex_count, "vertices")
                       : PointArray(mesh.vertices, mesh.stride, mesh.vertex_count, "vertices"),
          {faces, mesh.triangle_count}};
}

/// The same of mesh `number`, which errors name.
MeshArrays arrays_of(const grelha_mesh& mesh, std::size_t number) {
  const std::string name = "mesh " + std::to_string(number) + ": ";
  try {
    return arrays_of(mesh);
  } catch (const std::invalid_argument& bad) {
    throw std::invalid_argument(name + bad.what());
  } catch (const TooMany& bad) {
    throw TooMany(name + bad.what());
  }
}

OffsetScene scene_of_meshes(const grelha_mesh* meshes, std::size_t count) {
  if (count > 0)
    expect_there(meshes, "meshes");
  std::vector<MeshArrays> arrays;
  std::size_t vertices = 0, triangles = 0;
  for (std::size_t i = 0; i < count; ++i) {
    arrays.push_back(arrays_of(meshes[i], i));
    expect_at_most(vertices += meshes[i].vertex_count, kMostVertices - 2, "vertices of all");
    expect_at_most(triangles += meshes[i].triangle_count, kMostPrimitives, "triangles of all");
  }
  return scene_of(arrays);
}

/// A world of triangles. Throws std::invalid_argument.
grelha_world& meshes_of(grelha_world* world) {
  expect_there(world, "world");
  if (world->scene().geometry.spheres.size() > 0)
    refuse("world", "triangles", "spheres");
  return *world;
}

/// The vertices of a mesh, whose indices are not read.
PointArray vertices_of(const grelha_mesh& mesh) {
  return arrays_of({.vertices = mesh.vertices,
                    .doubles = mesh.doubles,
                    .stride = mesh.stride,
                    .vertex_count = mesh.vertex_count,
                    .indices = nullptr,
                    .triangle_count = 0})
      .vertices;
}

}  // namespace
}  // namespace grelha::c

grelha_status grelha_new_meshes(const grelha_mesh* meshes,
                                size_t count,
                                int threads,
                                grelha_world** world) {
  return grelha::c::make_world(
      world, threads, [&] { return grelha::c::scene_of_meshes(meshes, count); });
}

grelha_status grelha_mesh_of(const grelha_world* world,
                             const uint32_t* ids,
                             size_t count,
                             uint32_t* mesh,
                             uint32_t* triangle) {
  using namespace grelha::c;
  return guarded([&] {
    expect_there(world, "world");
    if (count > 0)
      expect_there(ids, "ids");
    const grelha::Geometry& g = world->scene().geometry;
    const std::size_t all = g.spheres.size() + g.triangles.size();
    for (std::size_t i = 0; i < count; ++i) {
      if (ids[i] >= all && ids[i] != GRELHA_NONE)
        refuse("ids", "ids below " + std::to_string(all), std::to_string(ids[i]));
      const grelha::MeshFace found = grelha::mesh_face(world->scene(), ids[i]);
      if (mesh)
        mesh[i] = found.mesh;
      if (triangle)
        triangle[i] = found.face;
    }
  });
}

grelha_status grelha_mesh_count(const grelha_world* world, size_t* count) {
  using namespace grelha::c;
  return guarded([&] {
    expect_there(world, "world");
    expect_there(count, "count");
    *count = mesh_count(world->scene());
  });
}

grelha_status grelha_update_mesh(grelha_world* world,
                                 size_t number,
                                 const grelha_mesh* mesh,
                                 int threads) {
  return grelha_update_meshes(world, &number, mesh, 1, threads);
}

grelha_status grelha_update_meshes(grelha_world* world,
                                   const size_t* numbers,
                                   const grelha_mesh* meshes,
                                   size_t count,
                                   int threads) {
  using namespace grelha::c;
  return guarded([&] {
    grelha_world& changed = meshes_of(world);
    if (count > 0) {
      expect_there(numbers, "numbers");
      expect_there(meshes, "mesh");
    }
    std::vector<grelha::MeshMove> moves;
    for (size_t i = 0; i < count; ++i)
      moves.push_back({numbers[i], vertices_of(meshes[i])});
    move_meshes(changed, moves, build_options(threads));
  });
}

grelha_status grelha_add_mesh(grelha_world* world,
                              const grelha_mesh* mesh,
                              int threads,
                              size_t* number) {
  using namespace grelha::c;
  return guarded([&] {
    grelha_world& changed = meshes_of(world);
    expect_there(mesh, "mesh");
    const grelha::MeshArrays added = arrays_of(*mesh);
    const grelha::Triangles& all = changed.scene().geometry.triangles;
    expect_at_most(all.vertex_count() + added.vertices.count, kMostVertices - 2, "vertices of all");
    expect_at_most(all.size() + added.faces.size(), kMostPrimitives, "triangles of all");
    add_mesh(changed, added, build_options(threads));
    if (number)
      *number = mesh_count(changed.scene()) - 1;
  });
}

grelha_status grelha_set_visible(grelha_world* world, size_t number, int visible, int threads) {
  using namespace grelha::c;
  return guarded(
      [&] { show_mesh(meshes_of(world), number, visible != 0, build_options(threads)); });
}

grelha_status grelha_remove_mesh(grelha_world* world, size_t number, int threads) {
  using namespace grelha::c;
  return guarded([&] { remove_mesh(meshes_of(world), number, build_options(threads)); });
}
