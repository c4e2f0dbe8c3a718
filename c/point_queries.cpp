#include <algorithm>
#include <span>
#include <string>

#include "c/world.hpp"
#include "grelha/all_hits.hpp"
#include "grelha/distance.hpp"

namespace grelha::c {
namespace {

/// Calls work(points, first) for copies of the points, a part at a time: the kernel wants them
/// without gaps, and a copy of all could be too large.
template <class Work>
void each_part(const PointArray& all, const Work& work) {
  constexpr std::size_t kPart = std::size_t{1} << 20;
  std::vector<Float3> points;
  for (std::size_t first = 0; first < all.count; first += kPart) {
    points.resize(std::min(kPart, all.count - first));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto at = [&](std::size_t a) { return static_cast<float>(all.at(first + i, a)); };
      points[i] = {at(0), at(1), at(2)};
    }
    work(std::span<const Float3>(points), first);
  }
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
                              uint8_t* inside,
                              int threads) {
  using namespace grelha::c;
  return guarded([&] {
    const grelha::World& asked = world_of(world);
    const grelha::PointArray all(points, stride, count, "points");
    if (count > 0)
      expect_there(inside, "inside");
    const grelha::QueryOptions options{.threads = expect_threads(threads)};
    each_part(all, [&](std::span<const grelha::Float3> part, std::size_t first) {
      grelha::contains(asked, part, {inside + first, part.size()}, options);
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
    const grelha::World& asked = world_of(world);
    const grelha::PointArray all(points, stride, count, "points");
    if (!(radius >= 0))
      refuse("radius", "0 or more", std::to_string(radius));
    const grelha::QueryOptions options{.threads = expect_threads(threads)};
    std::vector<grelha::ClosestPoint> answers;
    each_part(all, [&](std::span<const grelha::Float3> part, std::size_t first) {
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
                                      float* distance,
                                      int threads) {
  using namespace grelha::c;
  return guarded([&] {
    const grelha::World& asked = world_of(world);
    const grelha::PointArray all(points, stride, count, "points");
    if (count > 0)
      expect_there(distance, "distance");
    const grelha::QueryOptions options{.threads = expect_threads(threads)};
    each_part(all, [&](std::span<const grelha::Float3> part, std::size_t first) {
      grelha::signed_distances(asked, part, {distance + first, part.size()}, options);
    });
  });
}
