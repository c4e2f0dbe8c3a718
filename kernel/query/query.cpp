#define GRELHA_ISA scalar
#include "grelha/query.hpp"

#include <stdexcept>

#include "kernel/shapes/surface.hpp"
#include "kernel/query/variants.hpp"
#include "kernel/grid/world_impl.hpp"

namespace grelha {
namespace {

TraceSettings settings_of(int packet) {
  if (packet != 1 && packet != 16 && packet != 64 && packet != 256)
    throw std::invalid_argument("a packet holds 1, 16, 64 or 256 rays");
  return {packet == 1 ? Method::kSingle : Method::kPackets, packet, true};
}

/// Arrays that have no natural default.
void expect_arrays(const RaySpan& rays) {
  if (rays.count < 0)
    throw std::invalid_argument("a stream of rays has no negative length");
  if (rays.count == 0)
    return;
  for (const float* const array : {rays.ox, rays.oy, rays.oz})
    if (!array)
      throw std::invalid_argument("a stream of rays needs ox, oy and oz, where they start");
  for (const float* const array : {rays.dx, rays.dy, rays.dz})
    if (!array)
      throw std::invalid_argument("a stream of rays needs dx, dy and dz, where they go");
  if (!rays.t)
    throw std::invalid_argument("a stream of rays needs t, where they end and what they meet");
}

void expect_primitive(const PrimitiveIds& ids, std::uint32_t id) {
  if (id >= ids.end())
    throw std::invalid_argument("no primitive of this scene has this id");
}

using Loop = void (*)(const SceneView&, const RaySpan&, const TraceSettings&, TraceCounts&);

void trace(const World& world,
           const RaySpan& rays,
           const QueryOptions& options,
           TraceCounts* counts,
           Loop VariantLoops::*loop) {
  expect_arrays(rays);
  TraceCounts unread;
  (choose_variant(options.isa).loops.*loop)(
      world.impl().view, rays, settings_of(options.packet), counts ? *counts : unread);
}

scalar::Vec3<float> vec(const Float3& p) { return {p.x, p.y, p.z}; }
Float3 float3(const scalar::Vec3<float>& v) { return {v.x, v.y, v.z}; }

}  // namespace

void closest(const World& world,
             const RaySpan& rays,
             const QueryOptions& options,
             TraceCounts* counts) {
  trace(world, rays, options, counts, &VariantLoops::closest);
}
Hit closest(const World& world, const Ray& ray) {
  return best_variant().loops.closest_one(world.impl().view, ray);
}

void occluded(const World& world,
              const RaySpan& rays,
              const QueryOptions& options,
              TraceCounts* counts) {
  trace(world, rays, options, counts, &VariantLoops::occluded);
}
bool occluded(const World& world, const Ray& ray) {
  return best_variant().loops.occluded_one(world.impl().view, ray);
}

SurfacePoint surface(const World& world, const Ray& ray, const Hit& hit) {
  const World::Impl& w = world.impl();
  expect_primitive(w.primitives.ids, hit.id);
  const scalar::Surface<float> s = scalar::surface_of<float>(
      w.view.geometry, hit.id, vec(ray.org), vec(ray.dir), hit.t, w.shading.smooth);
  return {float3(s.point), float3(s.normal), float3(s.shading), s.away, s.material};
}

Float3 SurfacePoint::leave(Float3 dir) const {
  return float3(scalar::leave(vec(point), vec(normal), away, vec(dir)));
}

Primitive primitive_of(const World& world, std::uint32_t id) {
  const PrimitiveIds& ids = world.impl().primitives.ids;
  expect_primitive(ids, id);
  return ids.primitive(id);
}

}  // namespace grelha
