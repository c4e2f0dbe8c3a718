#pragma once
// Checks whether the triangles of a scene are a closed, oriented, manifold mesh.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "grelha/scene_spans.hpp"
#include "grelha/world.hpp"

namespace grelha {

/// An edge, by the first triangle that has it.
struct MeshEdge {
  std::uint32_t id;        ///< of the triangle
  std::uint32_t from, to;  ///< indices of vertices, in the order in which the triangle has them
};

/// How many of some kind there are, and those of the lowest ids.
template <class Item>
struct Findings {
  static constexpr std::size_t kMost = 8;  ///< of `first`
  std::size_t count = 0;
  std::vector<Item> first;  ///< at most kMost, by ascending id
};

/// The results of check_mesh(). Vertices at one place are one vertex, whatever their indices;
/// triangles with two corners at one place have no edges. Triangles that are not finite are left
/// out, as queries do.
struct MeshCheck {
  std::size_t triangles = 0;  ///< finite ones
  std::size_t vertices = 0;   ///< places of corners
  std::size_t edges = 0;
  Findings<MeshEdge> open_edges;  ///< of an odd number of triangles
  /// of an even number of triangles that do not go each way by halves
  Findings<MeshEdge> inconsistent_edges;
  Findings<MeshEdge> nonmanifold_edges;          ///< of more than two triangles
  Findings<std::uint32_t> duplicate_triangles;   ///< with the corners of one before, in any order
  Findings<std::uint32_t> degenerate_triangles;  ///< without area, exactly
  Findings<std::uint32_t> nonfinite_triangles;   ///< with a NaN or an infinity

  /// No edge is open: inside is defined by parity.
  bool is_closed() const { return open_edges.count == 0; }
  /// Neighbours agree on which side is the front.
  bool is_oriented() const { return inconsistent_edges.count == 0; }
  /// No edge has more than two triangles. Vertices at which two surfaces touch are not looked for.
  bool is_edge_manifold() const { return nonmanifold_edges.count == 0; }
};

/// Checks the triangles of a scene that are visible. Exact; takes time and memory in proportion to
/// their number. Triangles that cross each other are not looked for. Throws std::invalid_argument
/// if arrays have unequal lengths, a triangle names a vertex that is not there, or an object a
/// triangle.
MeshCheck check_mesh(const SceneSpans& scene);
/// The same of a World, which checks once and keeps the answer.
const MeshCheck& check_mesh(const World& world);

}  // namespace grelha
