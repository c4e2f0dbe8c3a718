#include "grelha/mesh_check.hpp"
#include "c/world.hpp"

namespace grelha::c {
namespace {

grelha_edges edges_of(const Findings<MeshEdge>& found) {
  if (found.count == 0)
    return {0, GRELHA_NONE, GRELHA_NONE, GRELHA_NONE};
  const MeshEdge& first = found.first[0];
  return {found.count, first.id, first.from, first.to};
}
grelha_ids ids_of(const Findings<std::uint32_t>& found) {
  return {found.count, found.count == 0 ? GRELHA_NONE : found.first[0]};
}

}  // namespace
}  // namespace grelha::c

grelha_status grelha_check_mesh(const grelha_world* world, grelha_mesh_check* found) {
  using namespace grelha::c;
  return guarded([&] {
    expect_there(found, "found");
    const grelha::MeshCheck& mesh = check_mesh(world_of(world));
    *found = {.triangles = mesh.triangles,
              .vertices = mesh.vertices,
              .edges = mesh.edges,
              .open = edges_of(mesh.open_edges),
              .inconsistent = edges_of(mesh.inconsistent_edges),
              .nonmanifold = edges_of(mesh.nonmanifold_edges),
              .duplicate = ids_of(mesh.duplicate_triangles),
              .degenerate = ids_of(mesh.degenerate_triangles),
              .nonfinite = ids_of(mesh.nonfinite_triangles)};
  });
}
