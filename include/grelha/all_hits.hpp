#pragma once
// All hits along a ray, and its passages through meshes. Thread-safe, as the queries of query.hpp.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "grelha/query.hpp"

namespace grelha {

/// All hits of many rays in one array.
struct HitLists {
  std::vector<std::size_t> offset;  ///< [rays + 1] hits of ray i: offset[i] to offset[i + 1] - 1
  std::vector<Hit> hits;            ///< ray after ray, each in order of (t, id)
  /// Returns the hits of ray i.
  std::span<const Hit> of(std::size_t i) const {
    return std::span(hits).subspan(offset[i], offset[i + 1] - offset[i]);
  }
};

/// Finds all hits of a ray strictly between its t_min and t_max, in order of (t, id). A ray that
/// enters and leaves a sphere or a cone hits it twice; crossings of one sphere or cone within 2^-45
/// of t count as one. An edge or a vertex belongs to each triangle that has it; crossings() pass it
/// once. Each exact copy of a primitive counts. The order is that of the exact t. The t returned
/// are rounded, so neighbours may be equal. The first hit has the same bits as closest().
std::vector<Hit> all_hits(const World& world, const Ray& ray, const Filter& filter = {});
/// The same, one hit after another, until `visit` returns false.
void all_hits(const World& world,
              const Ray& ray,
              const std::function<bool(const Hit&)>& visit,
              const Filter& filter = {});
/// The same for each ray of a stream. Throws what closest() throws.
HitLists all_hits(const World& world, const Rays& rays, const QueryOptions& options = {});

/// Counts the hits of each ray of a stream: counts[i] is the number of hits that all_hits() finds
/// for ray i. Throws what closest() throws, and std::invalid_argument if `counts` is null.
void count_hits(const World& world,
                const Rays& rays,
                std::uint32_t* counts,
                const QueryOptions& options = {});

/// A passage of a ray through a triangle.
struct Crossing {
  float t;           ///< as that of a hit
  std::uint32_t id;  ///< of the triangle
  bool enters;       ///< through the side from which the vertices are counter-clockwise
};

/// The crossings of many rays in one array.
struct CrossingLists {
  std::vector<std::size_t> offset;  ///< [rays + 1] those of ray i: offset[i] to offset[i + 1] - 1
  std::vector<Crossing> crossings;  ///< ray after ray, each in its order
  /// Returns the crossings of ray i.
  std::span<const Crossing> of(std::size_t i) const {
    return std::span(crossings).subspan(offset[i], offset[i + 1] - offset[i]);
  }
};

/// Finds the triangles that a ray crosses strictly between its t_min and t_max, in the order in
/// which it crosses them. Other primitives do not count; exact copies of a triangle do. A ray
/// through an edge or a vertex is treated as if it passed at an infinitesimal distance, on the same
/// side for all triangles. A ray that passes through a surface at an edge therefore crosses one
/// triangle there, and one that touches it none, or two at equal t: it enters and leaves. For a
/// closed mesh the number of crossings is odd from inside and even from outside, for every ray.
/// Simulation of simplicity, Edelsbrunner and Mücke 1990; docs/numerics.md.
std::vector<Crossing> crossings(const World& world, const Ray& ray, const Filter& filter = {});
/// The same for each ray of a stream. Throws what closest() throws.
CrossingLists crossings(const World& world, const Rays& rays, const QueryOptions& options = {});

/// Counts the crossings that crossings() finds.
std::size_t count_crossings(const World& world, const Ray& ray, const Filter& filter = {});
/// The same for each ray of a stream. Throws what closest() throws, and std::invalid_argument if
/// `counts` is null.
void count_crossings(const World& world,
                     const Rays& rays,
                     std::uint32_t* counts,
                     const QueryOptions& options = {});

}  // namespace grelha
