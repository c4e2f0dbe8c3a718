#pragma once
// Whether points lie inside closed meshes. Thread-safe, as the queries of query.hpp.

#include <cstdint>
#include <span>

#include "grelha/query.hpp"

namespace grelha {

/// Returns true if a point lies inside a ball of the scene, or inside an odd number of its closed
/// meshes. The triangles must form closed meshes; planes and cones do not count. The answer is
/// exact: it does not depend on a choice of ray. Points with a NaN or an infinity are outside.
bool contains(const World& world, Float3 point);
/// The same for many points: inside[i] is 1 or 0. Reads options.threads, options.isa and
/// options.progress. Throws std::invalid_argument if the lengths differ.
void contains(const World& world,
              std::span<const Float3> points,
              std::span<std::uint8_t> inside,
              const QueryOptions& options = {});

}  // namespace grelha
