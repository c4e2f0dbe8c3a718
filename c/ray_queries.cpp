#include <algorithm>
#include <cstdint>
#include <string>

#include "c/world.hpp"
#include "grelha/all_hits.hpp"

namespace grelha::c {

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

namespace {

constexpr std::size_t kPart = std::size_t{1} << 17;

/// Where a member of each item is stored, if it is wanted.
template <class Item, class Member, class To>
struct Column {
  Member Item::*member;
  To* to;
  void store(std::size_t first, const std::vector<Item>& items) const {
    for (std::size_t i = 0; to && i < items.size(); ++i)
      to[first + i] = items[i].*member;
  }
};
template <class Item, class Member, class To>
Column(Member Item::*, To*) -> Column<Item, Member, To>;

/// Finds items of many rays a part of them at a time. `list(part, options)` returns a part's items
/// with their offsets, which columns store, and `count(part, counts, options)` only counts them.
template <class List, class Count, class... Columns>
void list_by_parts(const Rays& rays,
                   QueryOptions options,
                   std::size_t* offset,
                   std::size_t capacity,
                   const List& list,
                   const Count& count,
                   const Columns&... columns) {
  const bool stores = (columns.to || ...);
  offset[0] = 0;
  each_part(rays.count, kPart, [&](Part range) {
    const Rays part = rays.part(range.first, range.end);
    options.progress = progress_of(range);
    std::size_t* const to = offset + range.first;
    if (stores && to[0] <= capacity) {
      const auto [offsets, items] = list(part, options);
      for (std::size_t i = 0; i < part.count; ++i)
        to[i + 1] = to[0] + offsets[i + 1];
      if (to[part.count] <= capacity)
        (columns.store(to[0], items), ...);
    } else {
      std::vector<std::uint32_t> counts(part.count);
      count(part, counts.data(), options);
      for (std::size_t i = 0; i < part.count; ++i)
        to[i + 1] = to[i] + counts[i];
    }
  });
  if (stores && offset[rays.count] > capacity)
    throw TooMany("capacity: expected at least " + std::to_string(offset[rays.count]) + ", found " +
                  std::to_string(capacity));
}

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
    list_by_parts(
        stream,
        options_of(world, threads),
        offset,
        capacity,
        [&](const auto& part, const auto& how) { return grelha::all_hits(asked, part, how); },
        [&](const auto& part, uint32_t* counts, const auto& how) {
          grelha::count_hits(asked, part, counts, how);
        },
        Column{&grelha::Hit::t, t},
        Column{&grelha::Hit::id, id});
  });
}

grelha_status grelha_crossings(const grelha_world* world,
                               const grelha_rays* rays,
                               size_t* offset,
                               float* t,
                               uint32_t* id,
                               uint8_t* enters,
                               size_t capacity,
                               int threads) {
  using namespace grelha::c;
  return guarded([&] {
    const grelha::World& asked = world_of(world);
    const grelha::Rays stream = rays_of(rays);
    expect_there(offset, "offset");
    list_by_parts(
        stream,
        options_of(world, threads),
        offset,
        capacity,
        [&](const auto& part, const auto& how) { return grelha::crossings(asked, part, how); },
        [&](const auto& part, uint32_t* counts, const auto& how) {
          grelha::count_crossings(asked, part, counts, how);
        },
        Column{&grelha::Crossing::t, t},
        Column{&grelha::Crossing::id, id},
        Column{&grelha::Crossing::enters, enters});
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
    const auto progress = progress_of();
    constexpr std::size_t kAsk = 1024;
    for (std::size_t i = 0; i < stream.count; ++i) {
      if (progress && i % kAsk == 0 &&
          !progress(static_cast<double>(i) / static_cast<double>(stream.count)))
        throw grelha::Stopped();
      const auto visit_hit = [&](const grelha::Hit& hit) {
        return visit(context, i, hit.t, hit.id) != 0;
      };
      const grelha::Filter filter{.skip = stream.skip ? stream.skip[i] : grelha::kNoPrimitive,
                                  .masks = world->masks(),
                                  .mask = stream.mask ? stream.mask[i] : std::uint8_t{255}};
      grelha::all_hits(asked, stream[i], visit_hit, filter);
    }
  });
}
