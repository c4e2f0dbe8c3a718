#include <algorithm>
#include <iterator>
#include <limits>

#include "grelha/distance.hpp"
#include "kernel/grid/world_impl.hpp"
#include "kernel/query/insides.hpp"
#include "kernel/query/runs.hpp"
#include "kernel/query/variants.hpp"

namespace grelha {
namespace {

constexpr float kAnyRadius = std::numeric_limits<float>::infinity();

float signed_by(bool inside, float distance) {
  return inside ? 0 - distance : distance;  // no zero is -0
}

}  // namespace

ClosestPoint closest_point(const World& world, Float3 point, float radius) {
  ClosestPoint found;
  best_variant().loops.closest_points(world.impl().view, &point, 1, radius, &found);
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
    loop(world.impl().view, &points[first], end - first, radius, &found[first]);
  };
  each_run(points.size(), options, work, kPoints);
}

float signed_distance(const World& world, Float3 point, InsideRule rule) {
  return signed_by(contains(world, point, rule), closest_point(world, point).distance);
}

void signed_distances(const World& world,
                      std::span<const Float3> points,
                      std::span<float> distances,
                      const QueryOptions& options) {
  expect_same_size(points.size(), distances.size(), "points");
  const Variant& variant = choose_variant(options.isa);
  prepare_insides(world, options.inside);
  const auto work = [&](std::size_t first, std::size_t end) {
    ClosestPoint found[kPoints.most];
    std::uint8_t inside[kPoints.most];
    for (std::size_t i = first; i < end; i += std::size(found)) {
      const std::size_t count = std::min(std::size(found), end - i);
      variant.loops.closest_points(world.impl().view, &points[i], count, kAnyRadius, found);
      find_insides(variant, world, points.subspan(i, count), options.inside, inside);
      for (std::size_t k = 0; k < count; ++k)
        distances[i + k] = signed_by(inside[k] != 0, found[k].distance);
    }
  };
  each_run(points.size(), options, work, kPoints);
}

}  // namespace grelha
