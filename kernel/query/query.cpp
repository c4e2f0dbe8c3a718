#define GRELHA_ISA scalar
#include "grelha/query.hpp"

#include <stdexcept>
#include <string>

#include "kernel/shapes/surface.hpp"
#include "kernel/query/options.hpp"
#include "kernel/grid/world_impl.hpp"

namespace grelha {
namespace {

/// Arrays that have no natural default.
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

void expect_same_size(std::size_t rays, std::size_t answers) {
  if (rays != answers)
    throw std::invalid_argument("expected an answer for each of " + std::to_string(rays) +
                                " rays, found room for " + std::to_string(answers));
}

void expect_primitive(const PrimitiveIds& ids, std::uint32_t id) {
  if (id >= ids.end())
    throw std::invalid_argument("no primitive of this scene has this id");
}

scalar::Vec3<float> vec(const Float3& p) {
  return {p.x, p.y, p.z};
}
Float3 float3(const scalar::Vec3<float>& v) {
  return {v.x, v.y, v.z};
}

}  // namespace

void closest(const World& world,
             const Rays& rays,
             const Hits& hits,
             const QueryOptions& options,
             TraceCounts* counts) {
  expect_arrays(rays);
  TraceCounts unread;
  choose_variant(options.isa)
      .loops.closest(
          world.impl().view, rays, hits, options_of(options.packet), counts ? *counts : unread);
}
void closest(const World& world,
             std::span<const Ray> rays,
             std::span<Hit> hits,
             const QueryOptions& options,
             TraceCounts* counts) {
  expect_same_size(rays.size(), hits.size());
  closest(world, Rays::of(rays), Hits::of(hits), options, counts);
}
Hit closest(const World& world, const Ray& ray) {
  return best_variant().loops.closest_one(world.impl().view, ray);
}

void occluded(const World& world,
              const Rays& rays,
              std::uint8_t* blocked,
              const QueryOptions& options,
              TraceCounts* counts) {
  expect_arrays(rays);
  if (!blocked && rays.count > 0)
    throw std::invalid_argument("occluded: expected an array of answers, found null");
  TraceCounts unread;
  choose_variant(options.isa)
      .loops.occluded(
          world.impl().view, rays, blocked, options_of(options.packet), counts ? *counts : unread);
}
void occluded(const World& world,
              std::span<const Ray> rays,
              std::span<std::uint8_t> blocked,
              const QueryOptions& options,
              TraceCounts* counts) {
  expect_same_size(rays.size(), blocked.size());
  occluded(world, Rays::of(rays), blocked.data(), options, counts);
}
bool occluded(const World& world, const Ray& ray) {
  return best_variant().loops.occluded_one(world.impl().view, ray);
}

SurfacePoint surface(const World& world, const Ray& ray, const Hit& hit) {
  const World::Impl& w = world.impl();
  expect_primitive(w.primitives.ids, hit.id);
  const scalar::Surface<float> s = scalar::surface_of<float>(
      w.view.geometry, hit.id, vec(ray.org), vec(ray.dir), hit.t, w.shading.smooth);
  return {
      float3(s.point),
      float3(s.normal),
      float3(s.shading),
      s.offset,
      s.material,
  };
}

Float3 SurfacePoint::offset_origin(Float3 dir) const {
  return float3(scalar::offset_origin(vec(point), vec(normal), offset, vec(dir)));
}

Primitive primitive_of(const World& world, std::uint32_t id) {
  const PrimitiveIds& ids = world.impl().primitives.ids;
  expect_primitive(ids, id);
  return ids.primitive(id);
}

}  // namespace grelha
