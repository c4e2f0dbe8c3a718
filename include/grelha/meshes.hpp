#pragma once
// Several meshes in one scene: whose a triangle is, and changes of one mesh.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "grelha/owning_world.hpp"
#include "grelha/rays.hpp"

namespace grelha {

/// One mesh among several.
struct MeshArrays {
  PointArray vertices;
  std::span<const std::array<std::uint32_t, 3>> faces;  ///< indices below vertices.count
};

/// Joins meshes into one scene: ids count the triangles of all, mesh after mesh. Doubles in one
/// mesh give all an offset, as scene_of() of one does. Throws what triangles_of() and scene_of() of
/// one throw; the messages begin with "mesh 3: ".
OffsetScene scene_of(std::span<const MeshArrays> meshes);

/// Number of meshes that a scene was joined of; 1 of others.
std::size_t mesh_count(const OffsetScene& scene);

/// A triangle of one mesh among several; kNoPrimitive for what is no triangle.
struct MeshFace {
  std::uint32_t mesh = kNoPrimitive;                 ///< number of the mesh
  std::uint32_t face = kNoPrimitive;                 ///< number of the triangle in it
  bool operator==(const MeshFace&) const = default;  ///< the same triangle
};
/// Whose triangle a primitive is.
MeshFace mesh_face(const OffsetScene& scene, std::uint32_t id);

/// Ranges of one mesh in the arrays of its scene.
struct MeshRange {
  Object triangles;                                  ///< of geometry.triangles
  std::uint32_t first_vertex = 0, vertex_count = 0;  ///< of its vertices
};
/// Throws std::invalid_argument for a number that no mesh has.
MeshRange mesh_range(const OffsetScene& scene, std::size_t mesh);

/// Replaces the vertices of one mesh by as many, and returns the triangles that moved. Doubles have
/// the offset subtracted, floats count from it. After doubles the offset is that of the PointBounds
/// of all, see PointBounds::offset(): it stays unless floats from there would be too coarse. Where
/// it changes, all vertices are rounded anew, and all triangles moved. Throws BadNumber and
/// std::invalid_argument, and then nothing has changed.
Object move_mesh(OffsetScene& scene, std::size_t mesh, const PointArray& vertices);

/// New vertices of a mesh, as many as before.
struct MeshMove {
  std::size_t mesh;
  PointArray vertices;
};
/// The same of some meshes. Also throws std::invalid_argument for a mesh that is named twice.
std::vector<Object> move_meshes(OffsetScene& scene, std::span<const MeshMove> moves);

/// Hides a mesh or shows it again. Ids stay. Throws std::invalid_argument for a number that no mesh
/// has.
void show_mesh(OffsetScene& scene, std::size_t mesh, bool visible);
/// Appends a mesh, whose vertices count as those of move_mesh(), and returns its triangles, or all
/// where the offset changes. The others keep their numbers and ids. Throws BadNumber and
/// std::invalid_argument, also for a scene with anything but triangles; then nothing has changed.
Object add_mesh(OffsetScene& scene, const MeshArrays& mesh);
/// Takes a mesh out, and returns the triangles behind it, or all where the offset changes as
/// move_mesh() says. Their ids become less by the number of its triangles, and numbers of later
/// meshes less by one; those before it keep theirs. Throws std::invalid_argument for a number that
/// no mesh has, and as add_mesh() does.
Object remove_mesh(OffsetScene& scene, std::size_t mesh);

/// The same of a World, whose grids over other meshes are mostly kept. Floats are moved, and meshes
/// hidden and shown, in a time that grows with what changes, not with the whole scene; additions
/// on average. Masks stay with their triangles, those of what was added are 255. No query may run
/// meanwhile. They throw what those above and the constructor of World throw, and then the World
/// and its scene are as before.
void move_meshes(OwningWorld& world, std::span<const MeshMove> moves, const BuildOptions& options);
/// See move_meshes().
void show_mesh(OwningWorld& world, std::size_t mesh, bool visible, const BuildOptions& options);
/// See move_meshes().
void add_mesh(OwningWorld& world, const MeshArrays& mesh, const BuildOptions& options);
/// See move_meshes(). Gives the memory of the mesh back.
void remove_mesh(OwningWorld& world, std::size_t mesh, const BuildOptions& options);

}  // namespace grelha
