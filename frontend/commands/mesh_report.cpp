#include "frontend/commands/mesh_report.hpp"

#include <cstdio>
#include <sstream>

#include "grelha/mesh_check.hpp"

namespace grelha {
namespace {

std::string place_of(const SceneFile& file, std::uint32_t vertex) {
  const Triangles& t = file.scene.geometry.triangles;
  const auto at = file.frame.outside(Float3{t.x[vertex], t.y[vertex], t.z[vertex]});
  std::ostringstream text;
  text.precision(9);
  text << '(' << at[0] << ", " << at[1] << ", " << at[2] << ')';
  return text.str();
}

std::string counted(std::size_t count, const char* what) {
  return std::to_string(count) + ' ' + what + (count == 1 ? "" : "s");
}

/// The number of edges of a kind, and where the first is.
std::string edges_text(const SceneFile& file, const Findings<MeshEdge>& found, const char* what) {
  const MeshEdge& first = found.first[0];
  return counted(found.count, what) + (found.count > 1 ? ", the first from " : ", from ") +
         place_of(file, first.from) + " to " + place_of(file, first.to);
}

Json to_json(const Findings<MeshEdge>& found) {
  Json first = Json::array();
  for (const MeshEdge& e : found.first)
    first.push_back({{"triangle", e.id}, {"from", e.from}, {"to", e.to}});
  return {{"count", found.count}, {"first", first}};
}
Json to_json(const Findings<std::uint32_t>& found) {
  return {{"count", found.count}, {"first", found.first}};
}

}  // namespace

std::string mesh_text(const SceneFile& file) {
  const MeshCheck mesh = check_mesh(file.scene);
  std::string text = "mesh          ";
  text += mesh.is_closed() ? "closed" : edges_text(file, mesh.open_edges, "open edge");
  text += mesh.is_oriented()
              ? "; oriented"
              : "; " + edges_text(file, mesh.inconsistent_edges, "inconsistent edge");
  std::string others;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0)
      others += (others.empty() ? "" : ", ") + counted(count, what);
  };
  add(mesh.nonmanifold_edges.count, "non-manifold edge");
  add(mesh.duplicate_triangles.count, "duplicate triangle");
  add(mesh.degenerate_triangles.count, "degenerate triangle");
  add(mesh.nonfinite_triangles.count, "non-finite triangle");
  return text + (mesh.is_edge_manifold() ? "; edge-manifold\n" : "\n") +
         (others.empty() ? "" : "              " + others + '\n');
}

Json mesh_json(const SceneFile& file) {
  const MeshCheck mesh = check_mesh(file.scene);
  return {{"closed", mesh.is_closed()},
          {"oriented", mesh.is_oriented()},
          {"edge_manifold", mesh.is_edge_manifold()},
          {"vertices", mesh.vertices},
          {"edges", mesh.edges},
          {"open_edges", to_json(mesh.open_edges)},
          {"inconsistent_edges", to_json(mesh.inconsistent_edges)},
          {"nonmanifold_edges", to_json(mesh.nonmanifold_edges)},
          {"duplicate_triangles", to_json(mesh.duplicate_triangles)},
          {"degenerate_triangles", to_json(mesh.degenerate_triangles)},
          {"nonfinite_triangles", to_json(mesh.nonfinite_triangles)}};
}

}  // namespace grelha
