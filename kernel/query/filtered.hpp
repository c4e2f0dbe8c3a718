#pragma once
// Closest hits of rays that leave out primitives, and where on a triangle they lie.

#include <utility>
#include <vector>

#include "kernel/query/filters.hpp"
#include "kernel/query/variants.hpp"

namespace grelha {

/// The closest hit that a filter lets pass, given the closest hit of all. Only rays whose closest
/// hit is left out search all their hits.
Hit filtered(const World& world, const Ray& ray, const Filter& filter, const Hit& closest);

/// Traces a part of a stream whose rays leave out primitives, or want barycentric coordinates.
class FilteredClosest {
 public:
  FilteredClosest(const World& world,
                  const Rays& rays,
                  const Hits& hits,
                  const QueryOptions& options);
  void trace(ClosestLoop loop, const TraceOptions& how, TraceCounts& counts);

 private:
  /// Stores an answer; `at`: barycentric coordinates.
  void store(std::size_t i, const Hit& hit, const std::pair<float, float>& at);

  const World& world_;
  const Rays& rays_;
  const Hits& hits_;
  const QueryOptions& options_;
  std::vector<Hit> found_;
};

/// Answers of the rays from `first` on.
Hits part_of(const Hits& hits, std::size_t first);

}  // namespace grelha
