#include "kernel/query/filters.hpp"

#include <stdexcept>
#include <string>

#include "kernel/grid/world_impl.hpp"

namespace grelha {

void expect_arrays(const Rays& rays) {
  if (rays.count > std::size_t{PTRDIFF_MAX})
    throw std::invalid_argument("rays: expected a count that memory can hold, found " +
                                std::to_string(rays.count));
  if (rays.count == 0)
    return;
  for (int a = 0; a < 3; ++a)
    if (!rays.org[a] || !rays.dir[a])
      throw std::invalid_argument(std::string("rays: expected an array of ") + "xyz"[a] + " of " +
                                  (rays.org[a] ? "directions" : "origins") + ", found null");
}

void expect_masks(const World& world, std::span<const std::uint8_t> masks) {
  const std::size_t count = world.impl().primitives.ids.end();
  if (!masks.empty() && masks.size() != count)
    throw std::invalid_argument("masks: expected one for each of " + std::to_string(count) +
                                " primitives, found " + std::to_string(masks.size()));
}

namespace {
float element(const float* array, std::ptrdiff_t stride, std::size_t i, float instead) {
  return array ? array[static_cast<std::ptrdiff_t>(i) * stride] : instead;
}
const float* moved(const float* array, std::ptrdiff_t stride, std::size_t by) {
  return array ? array + static_cast<std::ptrdiff_t>(by) * stride : nullptr;
}
}  // namespace

Ray ray_of(const Rays& rays, std::size_t i) {
  const auto three = [i](const float* const(&of)[3], std::ptrdiff_t stride) {
    return Float3{
        element(of[0], stride, i, 0), element(of[1], stride, i, 0), element(of[2], stride, i, 0)};
  };
  return {three(rays.org, rays.org_stride),
          three(rays.dir, rays.dir_stride),
          element(rays.t_min, rays.t_stride, i, 0),
          element(rays.t_max, rays.t_stride, i, Ray{}.t_max)};
}

Rays part_of(const Rays& rays, std::size_t first, std::size_t end) {
  Rays part = rays;
  for (int a = 0; a < 3; ++a) {
    part.org[a] = moved(rays.org[a], rays.org_stride, first);
    part.dir[a] = moved(rays.dir[a], rays.dir_stride, first);
  }
  part.t_min = moved(rays.t_min, rays.t_stride, first);
  part.t_max = moved(rays.t_max, rays.t_stride, first);
  part.skip = rays.skip ? rays.skip + first : nullptr;
  part.mask = rays.mask ? rays.mask + first : nullptr;
  part.count = end - first;
  return part;
}

Hits part_of(const Hits& hits, std::size_t first) {
  Hits part = hits;
  const auto by = static_cast<std::ptrdiff_t>(first);
  part.t = hits.t ? hits.t + by * hits.stride : nullptr;
  part.id = hits.id ? hits.id + by * hits.stride : nullptr;
  part.t_double = hits.t_double ? hits.t_double + first : nullptr;
  part.u = hits.u ? hits.u + first : nullptr;
  part.v = hits.v ? hits.v + first : nullptr;
  return part;
}

}  // namespace grelha
