#include <algorithm>
#include <span>
#include <string>

#include "c/world.hpp"
#include "grelha/all_hits.hpp"
#include "grelha/distance.hpp"

namespace grelha::c {
namespace {

/// Calls work(world, points, first, options) for copies of the points, a part at a time: the kernel
/// wants them without gaps, and a copy of all could be too large.
template <class Work>
void each_copy(const grelha_world* world,
               const PointArray& all,
               int threads,
               const Work& work,
               InsideRule rule = {}) {
  constexpr std::size_t kPart = std::size_t{1} << 20;
  const World& asked = world_of(world);
  QueryOptions options{.threads = expect_threads(threads), .inside = rule};
  std::vector<Float3> points;
  each_part(all.count, kPart, [&](Part part) {
    points.resize(part.end - part.first);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto at = [&](std::size_t a) { return static_cast<float>(all.at(part.first + i, a)); };
      points[i] = {at(0), at(1), at(2)};
    }
    options.progress = progress_of(part);
    work(asked, std::span<const Float3>(points), part.first, options);
  });
}

InsideRule rule_of(grelha_inside rule) {
  if (rule < GRELHA_CLOSED || rule > GRELHA_WINDING)
    refuse("rule", "0 to 3", std::to_string(static_cast<int>(rule)));
  static_assert(static_cast<int>(InsideRule::kWinding) == GRELHA_WINDING);
  return static_cast<InsideRule>(rule);
}

/// Stores what is wanted of some answers.
void store(std::span<const ClosestPoint> answers,
           std::size_t first,
           float* found,
           float* distance,
           std::uint32_t* id) {
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const ClosestPoint& answer = answers[i];
    if (found) {
      float* const to = found + 3 * (first + i);
      to[0] = answer.point.x;
      to[1] = answer.point.y;
      to[2] = answer.point.z;
    }
    if (distance)
      distance[first + i] = answer.distance;
    if (id)
      id[first + i] = answer.id;
  }
}

}  // namespace
}  // namespace grelha::c

grelha_status grelha_contains(const grelha_world* world,
                              const float* points,
                              ptrdiff_t stride,
                              size_t count,
                              grelha_inside rule,
                              uint8_t* inside,
                              int threads) {
  using namespace grelha::c;
  return guarded([&] {
    if (count > 0)
      expect_there(inside, "inside");
    const grelha::PointArray all(points, stride, count, "points");
    const auto work = [&](auto& asked, auto part, auto first, auto& options) {
      grelha::contains(asked, part, {inside + first, part.size()}, options);
    };
    each_copy(world, all, threads, work, rule_of(rule));
  });
}

grelha_status grelha_winding_numbers(const grelha_world* world,
                                     const float* points,
                                     ptrdiff_t stride,
                                     size_t count,
                                     double error,
                                     double* numbers,
                                     int threads) {
  using namespace grelha::c;
  return guarded([&] {
    if (!(error > 0))
      refuse("error", "more than 0", std::to_string(error));
    if (count > 0)
      expect_there(numbers, "numbers");
    const grelha::PointArray all(points, stride, count, "points");
    each_copy(world, all, threads, [&](auto& asked, auto part, auto first, auto& options) {
      grelha::winding_numbers(asked, part, {numbers + first, part.size()}, error, options);
    });
  });
}

grelha_status grelha_closest_points(const grelha_world* world,
                                    const float* points,
                                    ptrdiff_t stride,
                                    size_t count,
                                    float radius,
                                    float* found,
                                    float* distance,
                                    uint32_t* id,
                                    int threads) {
  using namespace grelha::c;
  return guarded([&] {
    if (!(radius >= 0))
      refuse("radius", "0 or more", std::to_string(radius));
    std::vector<grelha::ClosestPoint> answers;
    const grelha::PointArray all(points, stride, count, "points");
    each_copy(world, all, threads, [&](auto& asked, auto part, auto first, auto& options) {
      answers.resize(part.size());
      grelha::closest_points(asked, part, answers, radius, options);
      store(answers, first, found, distance, id);
    });
  });
}

grelha_status grelha_signed_distances(const grelha_world* world,
                                      const float* points,
                                      ptrdiff_t stride,
                                      size_t count,
                                      grelha_inside rule,
                                      float* distance,
                                      int threads) {
  using namespace grelha::c;
  return guarded([&] {
    if (count > 0)
      expect_there(distance, "distance");
    const grelha::PointArray all(points, stride, count, "points");
    const auto work = [&](auto& asked, auto part, auto first, auto& options) {
      grelha::signed_distances(asked, part, {distance + first, part.size()}, options);
    };
    each_copy(world, all, threads, work, rule_of(rule));
  });
}
