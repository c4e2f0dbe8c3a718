#include "grelha/all_hits.hpp"

#include <stdexcept>
#include <string>

#include "kernel/query/filters.hpp"
#include "kernel/query/hit_list.hpp"
#include "kernel/query/lists.hpp"

namespace grelha {

std::vector<Hit> all_hits(const World& world, const Ray& ray, const Filter& filter) {
  expect_masks(world, filter.masks);
  HitList list(world, filter);
  return list.find(ray);
}

void all_hits(const World& world,
              const Ray& ray,
              const std::function<bool(const Hit&)>& visit,
              const Filter& filter) {
  for (const Hit& hit : all_hits(world, ray, filter))
    if (!visit(hit))
      return;
}

HitLists all_hits(const World& world, const Rays& rays, const QueryOptions& options) {
  expect_arrays(rays);
  expect_masks(world, options.mask);
  HitLists lists;
  list_each(rays.count, options, lists.offset, lists.hits, [&](std::size_t i) {
    const Filter filter = filter_of(rays, options, i);
    HitList list(world, filter);
    return list.find(ray_of(rays, i));
  });
  return lists;
}

void count_hits(const World& world,
                const Rays& rays,
                std::uint32_t* counts,
                const QueryOptions& options) {
  expect_arrays(rays);
  expect_masks(world, options.mask);
  if (!counts && rays.count > 0)
    throw std::invalid_argument("count_hits: expected an array of counts, found null");
  each_run(rays.count, options, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      const Filter filter = filter_of(rays, options, i);
      HitList list(world, filter);
      counts[i] = static_cast<std::uint32_t>(list.find(ray_of(rays, i)).size());
    }
  });
}

}  // namespace grelha
