#pragma once
// Closest points and signed distances. Thread-safe, as the queries of query.hpp.

#include <cstdint>
#include <limits>
#include <span>

#include "grelha/inside.hpp"
#include "grelha/query.hpp"

namespace grelha {

/// The point of a scene that is closest to a given one.
struct ClosestPoint {
  Float3 point;  ///< on the primitive, rounded once; the given point if there is none
  float distance = std::numeric_limits<float>::infinity();  ///< infinity if there is none
  std::uint32_t id = kNoPrimitive;                          ///< see primitive_of()
  /// True if there is one within the radius.
  explicit operator bool() const { return id != kNoPrimitive; }
};

/// Finds the closest point of all surfaces within `radius` of a point, the distance included.
/// Computed in double, and in numbers of 106 bits on slivers, with an error of at most 2^-40 of the
/// larger of the distance and the coordinates, then rounded. Of two primitives at equal computed
/// distance, the one with the lower id is returned. Cones have no end caps. Points with a NaN or an
/// infinity have none.
ClosestPoint closest_point(const World& world,
                           Float3 point,
                           float radius = std::numeric_limits<float>::infinity());
/// The same for many points, faster where each is near the one before. Reads options.threads,
/// options.isa and options.progress. Throws std::invalid_argument if the lengths differ.
void closest_points(const World& world,
                    std::span<const Float3> points,
                    std::span<ClosestPoint> found,
                    float radius = std::numeric_limits<float>::infinity(),
                    const QueryOptions& options = {});

/// Returns the distance to the closest surface, negative inside; see contains() for what inside
/// means, and for what throws. 0 has no sign. Infinity if the scene is empty.
float signed_distance(const World& world, Float3 point, InsideRule rule = InsideRule::kClosed);
/// The same for many points, faster where each is near the one before. Reads options.inside,
/// options.threads, options.isa and options.progress. Throws std::invalid_argument if the lengths
/// differ.
void signed_distances(const World& world,
                      std::span<const Float3> points,
                      std::span<float> distances,
                      const QueryOptions& options = {});

}  // namespace grelha
