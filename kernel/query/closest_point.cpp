#include <limits>

#include "grelha/all_hits.hpp"
#include "grelha/distance.hpp"
#include "kernel/grid/world_impl.hpp"
#include "kernel/query/runs.hpp"
#include "kernel/query/variants.hpp"

namespace grelha {

ClosestPoint closest_point(const World& world, Float3 point, float radius) {
  ClosestPoint found;
  best_variant().loops.closest_points(
      world.impl().view, &point, 1, radius, kNoPrimitive, &found);
  return found;
}

void closest_points(const World& world,
                    std::span<const Float3> points,
                    std::span<ClosestPoint> found,
                    float radius,
                    const QueryOptions& options) {
  expect_same_size(points.size(), found.size(), "points");
  const ClosestPointsLoop loop = choose_variant(options.isa).loops.closest_points;
  const auto work = [&](std::size_t first, std::size_t end) {
    loop(world.impl().view, &points[first], end - first, radius, kNoPrimitive, &found[first]);
  };
  each_run(points.size(), options, work, kPoints);
}

float signed_distance(const World& world, Float3 point) {
  const float distance = closest_point(world, point).distance;
  return contains(world, point) ? 0 - distance : distance;  // no zero is -0
}

void signed_distances(const World& world,
                      std::span<const Float3> points,
                      std::span<float> distances,
                      const QueryOptions& options) {
  expect_same_size(points.size(), distances.size(), "points");
  const ClosestPointsLoop loop = choose_variant(options.isa).loops.closest_points;
  const auto work = [&](std::size_t first, std::size_t end) {
    ClosestPoint found;
    std::uint32_t near = kNoPrimitive;
    for (std::size_t i = first; i < end; ++i) {
      near = loop(world.impl().view,
                  &points[i],
                  1,
                  std::numeric_limits<float>::infinity(),
                  near,
                  &found);
      distances[i] = contains(world, points[i]) ? 0 - found.distance : found.distance;
    }
  };
  each_run(points.size(), options, work, kPoints);
}

}  // namespace grelha
