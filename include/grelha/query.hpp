#pragma once
// Ray queries. All functions are thread-safe: any number of threads may call them at the same time,
// on one World or on several. A World does not change, and a call writes only to the arrays passed
// to it.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

#include "grelha/geometry.hpp"
#include "grelha/rays.hpp"
#include "grelha/stats.hpp"
#include "grelha/world.hpp"

namespace grelha {

/// Which points count as inside of the triangles of a scene.
enum class InsideRule : std::uint8_t {
  kClosed,   ///< as kOdd, of closed meshes alone
  kOdd,      ///< in an odd number of meshes; of an open one, by the crossings of one ray
  kNonzero,  ///< around which closed and oriented meshes wind at all: unions, doubled walls
  /// with a winding_number() above 1/2, or below -1/2: open meshes, loose triangles
  kWinding
};

/// How a stream of rays or points is asked. Only `mask` and `inside` change the results.
struct QueryOptions {
  /// largest number of consecutive rays that are traced as one packet: 1, 16, 64 or 256
  int packet = 256;
  std::string_view isa = "best";  ///< see isas()
  int threads = 1;                ///< threads that share the rays or points; 0: one per processor
  /// [primitives] masks by id, see Rays::mask; empty: 255 for all
  std::span<const std::uint8_t> mask{};
  InsideRule inside = InsideRule::kClosed;  ///< read by contains() and signed_distances()
  /// Called repeatedly, by one thread at a time, with the fraction done. If it returns false, the
  /// query throws Stopped, and some answers are not written.
  std::function<bool(double)> progress{};
};

/// Primitives that one ray does not hit.
struct Filter {
  std::uint32_t skip = kNoPrimitive;      ///< id of a primitive that is left out
  std::span<const std::uint8_t> masks{};  ///< [primitives] by id; empty: 255 for all
  std::uint8_t mask = 255;                ///< primitives p with (masks[p] & mask) == 0 are left out
};

/// Finds the nearest hit of each ray of a stream. The stream may have any length. Long streams are
/// faster per ray, and coherent ones fastest: consecutive rays with similar origins and directions.
/// Runs on the calling thread unless options.threads says otherwise. Of two hits at equal t the one
/// with the lower id is returned. The result of a ray has the same bits whatever other rays the
/// stream contains. If `counts` is given, the work done is added to it. Throws
/// std::invalid_argument for an unknown packet size, an instruction set that is unknown or
/// unsupported here, a wrong number of masks, and for rays without origins or directions.
void closest(const World& world,
             const Rays& rays,
             const Hits& hits,
             const QueryOptions& options = {},
             TraceCounts* counts = nullptr);
/// The same for an array of rays. Also throws std::invalid_argument if the lengths of `rays` and
/// `hits` differ.
void closest(const World& world,
             std::span<const Ray> rays,
             std::span<Hit> hits,
             const QueryOptions& options = {},
             TraceCounts* counts = nullptr);
/// The same of one ray.
Hit closest(const World& world, const Ray& ray);
/// The same of one ray that leaves out some primitives. Throws std::invalid_argument if
/// filter.masks is not empty and has another length than the scene has primitives.
Hit closest(const World& world, const Ray& ray, const Filter& filter);

/// Tests each ray for any hit between its t_min and t_max. Writes rays.count answers: blocked[i] is
/// 1 if ray i hits something, else 0. Faster than closest(). Throws what closest() throws, and
/// std::invalid_argument if `blocked` is null.
void occluded(const World& world,
              const Rays& rays,
              std::uint8_t* blocked,
              const QueryOptions& options = {},
              TraceCounts* counts = nullptr);
/// The same for an array of rays. Also throws std::invalid_argument if the lengths of `rays` and
/// `blocked` differ.
void occluded(const World& world,
              std::span<const Ray> rays,
              std::span<std::uint8_t> blocked,
              const QueryOptions& options = {},
              TraceCounts* counts = nullptr);
/// The same of one ray.
bool occluded(const World& world, const Ray& ray);
/// The same of one ray that leaves out some primitives. Throws as closest() does.
bool occluded(const World& world, const Ray& ray, const Filter& filter);

/// The surface at a hit point, and the start points of new rays from there.
struct SurfacePoint {
  Float3 point;  ///< computed on the primitive; more accurate than org + t dir
  /// unit geometric normal; points outwards, for triangles to the side from which the vertices are
  /// counter-clockwise
  Float3 normal;
  /// unit shading normal, on the same side: interpolated vertex normals if the triangle has them,
  /// else `normal`
  Float3 shading;
  union {
    float offset;  ///< distance along the normal where a point is certainly off the surface
    float away;    ///< the same by its former name, for one version more
  };
  std::uint32_t material;  ///< index into the scene's materials
  /// Returns the origin of a ray that leaves the surface in direction `dir`, to be traced with
  /// t_min = 0. The ray does not hit this surface again if it points away from it. It misses
  /// nothing that is farther from the surface than 2 * `offset`. See docs/numerics.md, after Pharr,
  /// Jakob and Humphreys, PBR 4th ed., 6.8. A shadow ray starts at this origin, its direction is
  /// the light's position minus this origin, and its t_max is 1.
  Float3 start(Float3 dir) const;
  /// The same by a former name, for one version more.
  [[deprecated("use start()")]] Float3 offset_origin(Float3 dir) const { return start(dir); }
  /// The same by a former name, for one version more.
  [[deprecated("use start()")]] Float3 leave(Float3 dir) const { return start(dir); }
};

/// Computes the surface point of a `hit` that closest() returned for `ray`. Throws
/// std::invalid_argument if hit.id is not the id of a primitive, for example kNoPrimitive.
SurfacePoint surface(const World& world, const Ray& ray, const Hit& hit);
/// The same for many rays and their hits. Rays without a hit get a point of NaN. Throws
/// std::invalid_argument if the lengths differ.
void surfaces(const World& world,
              std::span<const Ray> rays,
              std::span<const Hit> hits,
              std::span<SurfacePoint> points,
              const QueryOptions& options = {});

/// Computes the surface point of primitive `id` that is nearest to a given point: where rays start
/// that leave a known point of a known primitive, without an epsilon. `shading` is `normal` unless
/// the triangle has vertex normals. Throws std::invalid_argument if there is no primitive `id`.
SurfacePoint surface_at(const World& world, std::uint32_t id, Float3 point);
/// The same of the point (1 - u - v) a + u b + v c of a triangle a b c, see Hits::u. Throws
/// std::invalid_argument if `id` is no triangle, and if u or v is less than 0, or their sum greater
/// than 1, by more than 1e-6.
SurfacePoint surface_at(const World& world, std::uint32_t id, double u, double v);
/// The same for many places, for example those that closest() found. Ids of kNoPrimitive get a
/// point of NaN. Throws std::invalid_argument if the lengths differ.
void surfaces_at(const World& world,
                 std::span<const std::uint32_t> ids,
                 std::span<const float> u,
                 std::span<const float> v,
                 std::span<SurfacePoint> points,
                 const QueryOptions& options = {});

/// Returns the kind and index of the primitive with this id. Throws std::invalid_argument if there
/// is none. Ids count planes first, then spheres, triangles and cones, each kind in the order of
/// the caller's arrays.
Primitive primitive_of(const World& world, std::uint32_t id);

}  // namespace grelha
