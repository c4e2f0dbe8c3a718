#pragma once
// Queries: what the caller's rays meet. Any number of threads may call any function at once, on one
// World or on many. A World does not change, and a call writes only the arrays it was given.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "grelha/geometry.hpp"
#include "grelha/rays.hpp"
#include "grelha/stats.hpp"
#include "grelha/world.hpp"

namespace grelha {

/// How a stream of rays is traced. None of it changes an answer.
struct QueryOptions {
  /// most neighbours that march together: 1, 16, 64 or 256
  int packet = 256;
  std::string_view isa = "best";  ///< see isas()
};

/// The nearest hit of each ray of a packet, or of a stream of any length: the longer the faster,
/// and fastest where neighbours go a similar way. Runs on the calling thread. Of two hits at equal
/// t the lower id wins. Each ray is told the same bits alone and in any company.
/// `counts`, where given, grows by what was done. Throws std::invalid_argument for a packet size or
/// an instruction set that is not there, and for rays without origins or directions.
void closest(const World& world,
             const Rays& rays,
             const Hits& hits,
             const QueryOptions& options = {},
             TraceCounts* counts = nullptr);
/// The same of an array of rays; throws as well where there are not as many hits.
void closest(const World& world,
             std::span<const Ray> rays,
             std::span<Hit> hits,
             const QueryOptions& options = {},
             TraceCounts* counts = nullptr);
/// The same of one ray.
Hit closest(const World& world, const Ray& ray);

/// Whether anything at all is in the way of each ray, between its t_min and t_max: blocked[i]
/// becomes 1 or 0, of rays.count of them. Faster than closest(); throws as that does, and where
/// `blocked` is null.
void occluded(const World& world,
              const Rays& rays,
              std::uint8_t* blocked,
              const QueryOptions& options = {},
              TraceCounts* counts = nullptr);
/// The same of an array of rays; throws as well where there are not as many answers.
void occluded(const World& world,
              std::span<const Ray> rays,
              std::span<std::uint8_t> blocked,
              const QueryOptions& options = {},
              TraceCounts* counts = nullptr);
/// The same of one ray.
bool occluded(const World& world, const Ray& ray);

/// How many triangles a ray crosses between its t_min and t_max. Other primitives do not count, and
/// exact copies of a triangle may count as one. Edges and corners are decided as if the ray lay
/// beside them by less than any number, the same way for all. So of a closed mesh the count is odd
/// from inside and even from outside, whatever ray is chosen. Simulation of simplicity,
/// Edelsbrunner and Mücke 1990; docs/numerics.md.
std::size_t count_crossings(const World& world, const Ray& ray);

/// Where a ray met a surface, and where new rays leave it.
struct SurfacePoint {
  Float3 point;  ///< taken from the primitive, nearer to it than org + t dir
  /// unit; the primitive's own: outwards, of triangles to the side they are counter-clockwise from
  Float3 normal;
  /// unit, on the same side: mixed from vertex normals where a triangle has them, else `normal`
  Float3 shading;
  float away;              ///< so far along the normal a ray is certainly off the surface
  std::uint32_t material;  ///< the primitive's, index into the scene's
  /// The start of a ray that leaves in direction `dir`, with t_min = 0. It does not meet a surface
  /// it points away from again. It skips nothing farther from that than 2 away. See
  /// docs/numerics.md, after Pharr, Jakob and Humphreys, PBR 4th ed., 6.8. A ray to a light starts
  /// here, goes to the light itself and searches up to t = 1.
  Float3 leave(Float3 dir) const;
};

/// The surface that `ray` met: what a `hit` of closest() names, at its t. Throws
/// std::invalid_argument for an id that no primitive has, as kNoPrimitive.
SurfacePoint surface(const World& world, const Ray& ray, const Hit& hit);

/// The primitive of an id that a hit named; throws as surface() does. Ids run over planes, spheres,
/// triangles, cones, each kind in the caller's order.
Primitive primitive_of(const World& world, std::uint32_t id);

}  // namespace grelha
