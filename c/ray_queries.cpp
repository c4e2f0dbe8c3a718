#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "c/world.hpp"
#include "grelha/all_hits.hpp"

namespace grelha::c {
namespace {

/// Floats from one element to the next; 0 where all rays share one.
std::ptrdiff_t floats_of(std::ptrdiff_t stride, std::size_t count, const char* name) {
  constexpr std::ptrdiff_t kSize = sizeof(float);
  if (count <= 1 || stride == GRELHA_SHARED)
    return 0;
  if (stride == 0 || stride % kSize != 0)
    refuse(name,
           "a multiple of 4 bytes (12 for points that follow each other) or GRELHA_SHARED",
           std::to_string(stride));
  return stride / kSize;
}

void expect_floats(const float* array, const char* name) {
  expect_there(array, name);
  if (reinterpret_cast<std::uintptr_t>(array) % alignof(float) != 0)
    refuse(name, "an address that is a multiple of 4", "another");
}

Rays rays_of(const grelha_rays* rays) {
  expect_there(rays, "rays");
  if (rays->count == 0)
    return {};
  expect_floats(rays->org, "org");
  expect_floats(rays->dir, "dir");
  return {.org = {rays->org, rays->org + 1, rays->org + 2},
          .dir = {rays->dir, rays->dir + 1, rays->dir + 2},
          .t_min = rays->t_min,
          .t_max = rays->t_max,
          .skip = rays->skip,
          .mask = rays->mask,
          .count = rays->count,
          .org_stride = floats_of(rays->org_stride, rays->count, "org_stride"),
          .dir_stride = floats_of(rays->dir_stride, rays->count, "dir_stride")};
}

const float* moved(const float* array, std::ptrdiff_t stride, std::size_t by) {
  return array + static_cast<std::ptrdiff_t>(by) * stride;
}

/// Rays [first, end).
Rays part_of(const Rays& rays, std::size_t first, std::size_t end) {
  Rays part = rays;
  for (int a = 0; a < 3; ++a) {
    part.org[a] = moved(rays.org[a], rays.org_stride, first);
    part.dir[a] = moved(rays.dir[a], rays.dir_stride, first);
  }
  part.t_min = rays.t_min ? rays.t_min + first : nullptr;
  part.t_max = rays.t_max ? rays.t_max + first : nullptr;
  part.skip = rays.skip ? rays.skip + first : nullptr;
  part.mask = rays.mask ? rays.mask + first : nullptr;
  part.count = end - first;
  return part;
}

Ray ray_of(const Rays& rays, std::size_t i) {
  const Rays one = part_of(rays, i, i + 1);
  Ray ray{{*one.org[0], *one.org[1], *one.org[2]}, {*one.dir[0], *one.dir[1], *one.dir[2]}};
  if (one.t_min)
    ray.t_min = *one.t_min;
  if (one.t_max)
    ray.t_max = *one.t_max;
  return ray;
}

/// Finds all hits a part of the rays at a time, so that they are in memory twice only in part.
class AllHits {
 public:
  AllHits(const World& world, const Rays& rays, QueryOptions options)
      : world_(world), rays_(rays), options_(std::move(options)) {}

  void find(std::size_t* offset, float* t, std::uint32_t* id, std::size_t capacity) const {
    constexpr std::size_t kPart = std::size_t{1} << 17;
    offset[0] = 0;
    for (std::size_t first = 0; first < rays_.count; first += kPart) {
      const Rays part = part_of(rays_, first, std::min(rays_.count, first + kPart));
      if ((t || id) && offset[first] <= capacity)
        list(part, offset + first, t, id, capacity);
      else
        count(part, offset + first);
    }
    const std::size_t all = offset[rays_.count];
    if ((t || id) && all > capacity)
      throw TooMany("capacity: expected at least " + std::to_string(all) + ", found " +
                    std::to_string(capacity));
  }

 private:
  void list(const Rays& part,
            std::size_t* offset,
            float* t,
            std::uint32_t* id,
            std::size_t capacity) const {
    const HitLists lists = all_hits(world_, part, options_);
    const std::size_t first = offset[0];
    for (std::size_t i = 0; i < part.count; ++i)
      offset[i + 1] = first + lists.offset[i + 1];
    if (offset[part.count] > capacity)
      return;
    for (std::size_t i = 0; t && i < lists.hits.size(); ++i)
      t[first + i] = lists.hits[i].t;
    for (std::size_t i = 0; id && i < lists.hits.size(); ++i)
      id[first + i] = lists.hits[i].id;
  }
  void count(const Rays& part, std::size_t* offset) const {
    std::vector<std::uint32_t> counts(part.count);
    count_hits(world_, part, counts.data(), options_);
    for (std::size_t i = 0; i < part.count; ++i)
      offset[i + 1] = offset[i] + counts[i];
  }

  const World& world_;
  const Rays& rays_;
  QueryOptions options_;
};

}  // namespace
}  // namespace grelha::c

grelha_status grelha_closest(const grelha_world* world,
                             const grelha_rays* rays,
                             const grelha_hits* hits,
                             int threads) {
  using namespace grelha::c;
  return guarded([&] {
    const grelha::World& asked = world_of(world);
    const grelha::Rays stream = rays_of(rays);
    expect_there(hits, "hits");
    const grelha::Hits answers{.t = hits->t, .id = hits->id, .u = hits->u, .v = hits->v};
    grelha::closest(asked, stream, answers, options_of(world, threads));
  });
}

grelha_status grelha_occluded(const grelha_world* world,
                              const grelha_rays* rays,
                              uint8_t* blocked,
                              int threads) {
  using namespace grelha::c;
  return guarded([&] {
    const grelha::World& asked = world_of(world);
    const grelha::Rays stream = rays_of(rays);
    if (stream.count > 0)
      expect_there(blocked, "blocked");
    grelha::occluded(asked, stream, blocked, options_of(world, threads));
  });
}

grelha_status grelha_count_hits(const grelha_world* world,
                                const grelha_rays* rays,
                                uint32_t* counts,
                                int threads) {
  using namespace grelha::c;
  return guarded([&] {
    const grelha::World& asked = world_of(world);
    const grelha::Rays stream = rays_of(rays);
    if (stream.count > 0)
      expect_there(counts, "counts");
    grelha::count_hits(asked, stream, counts, options_of(world, threads));
  });
}

grelha_status grelha_all_hits(const grelha_world* world,
                              const grelha_rays* rays,
                              size_t* offset,
                              float* t,
                              uint32_t* id,
                              size_t capacity,
                              int threads) {
  using namespace grelha::c;
  return guarded([&] {
    const grelha::World& asked = world_of(world);
    const grelha::Rays stream = rays_of(rays);
    expect_there(offset, "offset");
    AllHits(asked, stream, options_of(world, threads)).find(offset, t, id, capacity);
  });
}

grelha_status grelha_each_hit(const grelha_world* world,
                              const grelha_rays* rays,
                              grelha_visit visit,
                              void* context) {
  using namespace grelha::c;
  return guarded([&] {
    const grelha::World& asked = world_of(world);
    const grelha::Rays stream = rays_of(rays);
    if (!visit)
      refuse("visit", "a function", "null");
    for (std::size_t i = 0; i < stream.count; ++i) {
      const auto visit_hit = [&](const grelha::Hit& hit) {
        return visit(context, i, hit.t, hit.id) != 0;
      };
      const grelha::Filter filter{.skip = stream.skip ? stream.skip[i] : grelha::kNoPrimitive,
                                  .masks = world->masks,
                                  .mask = stream.mask ? stream.mask[i] : std::uint8_t{255}};
      grelha::all_hits(asked, ray_of(stream, i), visit_hit, filter);
    }
  });
}
