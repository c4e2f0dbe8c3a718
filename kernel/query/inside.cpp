#include "grelha/inside.hpp"

#include <algorithm>
#include <iterator>

#include "grelha/all_hits.hpp"
#include "kernel/grid/world_impl.hpp"
#include "kernel/query/crossing_sum.hpp"
#include "kernel/query/insides.hpp"
#include "kernel/query/runs.hpp"

namespace grelha {
namespace {

/// How often the ray from a point leaves meshes, less how often it enters them.
std::int64_t winding(const World& world, Float3 point, const CrossingSum& sum) {
  if (sum.is_whole)
    return sum.outwards;
  std::int64_t outwards = 0;
  for (const Crossing& at : crossings(world, {point, scalar::kInsideDirection}))
    outwards += at.enters ? -1 : 1;
  return outwards;
}

}  // namespace

void find_insides(const Variant& variant,
                  const World& world,
                  std::span<const Float3> points,
                  std::uint8_t* inside) {
  CrossingSum sums[64];
  for (std::size_t i = 0; i < points.size(); i += std::size(sums)) {
    const std::size_t count = std::min(std::size(sums), points.size() - i);
    variant.loops.sum_crossings(world.impl().view, &points[i], count, sums);
    for (std::size_t k = 0; k < count; ++k)
      inside[i + k] = sums[k].in_sphere || winding(world, points[i + k], sums[k]) % 2 != 0;
  }
}

bool contains(const World& world, Float3 point) {
  std::uint8_t inside = 0;
  find_insides(best_variant(), world, {&point, 1}, &inside);
  return inside != 0;
}

void contains(const World& world,
              std::span<const Float3> points,
              std::span<std::uint8_t> inside,
              const QueryOptions& options) {
  expect_same_size(points.size(), inside.size(), "points");
  const Variant& variant = choose_variant(options.isa);
  const auto work = [&](std::size_t first, std::size_t end) {
    find_insides(variant, world, points.subspan(first, end - first), &inside[first]);
  };
  each_run(points.size(), options, work, kPoints);
}

}  // namespace grelha
