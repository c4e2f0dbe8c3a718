#pragma once
// Tests whether points lie inside meshes. Thread-safe, as the queries of query.hpp.

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "grelha/mesh_check.hpp"
#include "grelha/query.hpp"

namespace grelha {

/// Thrown where a rule asks for a closed mesh and finds an edge that is open, or for an oriented
/// one and finds an edge at which the front changes sides. what() says how many, where the first
/// is, and which rule takes such a mesh.
struct NotClosed : std::invalid_argument {
  /// The error of a mesh; `edge` is the first such edge.
  NotClosed(const std::string& text, const MeshEdge& first)
      : std::invalid_argument(text), edge(first) {}
  MeshEdge edge;  ///< the first
};

/// Returns true if a point lies inside a ball of the scene, or inside its meshes by a rule; planes
/// and cones do not count. By every rule but InsideRule::kWinding the answer is exact: where the
/// mesh is closed, it does not depend on a choice of ray. Points with a NaN or an infinity are
/// outside. Throws NotClosed if the rule does not take the mesh. The first call checks the mesh, or
/// for InsideRule::kWinding puts it into clusters, and the World keeps what it found.
bool contains(const World& world, Float3 point, InsideRule rule = InsideRule::kClosed);
/// The same for many points, by options.inside: inside[i] is 1 or 0. Reads options.threads,
/// options.isa and options.progress. Throws std::invalid_argument if the lengths differ.
void contains(const World& world,
              std::span<const Float3> points,
              std::span<std::uint8_t> inside,
              const QueryOptions& options = {});

/// Returns the generalized winding number of the triangles around a point: the sum of their solid
/// angles over 4 pi. It is how often a closed mesh winds around the point; of an open one, how much
/// of all directions it covers, counter-clockwise triangles being seen from behind. A triangle that
/// the point lies in adds 0.
///
/// Accuracy  within `error` of the number, and the rounding of doubles, except for points that are
///           nearer to an edge than 2^-24 of its length. The less error is allowed, the longer it
///           takes. Same bits on every machine, by every instruction set, and for any grids.
/// Source    Jacobson et al. 2013; Barill et al. 2018; docs/numerics.md.
///
/// NaN for a point with a NaN or an infinity. Throws std::invalid_argument unless error > 0.
double winding_number(const World& world, Float3 point, double error = 0x1p-7);
/// The same for many points. Reads options.threads, options.isa and options.progress. Throws
/// std::invalid_argument if the lengths differ.
void winding_numbers(const World& world,
                     std::span<const Float3> points,
                     std::span<double> numbers,
                     double error = 0x1p-7,
                     const QueryOptions& options = {});

}  // namespace grelha
