#define GRELHA_ISA scalar
#include "grelha/query.hpp"

#include <cassert>
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

using Loop = void (*)(const SceneView&, const RaySpan&, const TraceSettings&, TraceCounts&);

void trace(const World& world,
           const RaySpan& rays,
           const QueryOptions& options,
           TraceCounts* counts,
           Loop VariantLoops::*loop) {
  if (rays.count < 0)
    throw std::invalid_argument("a stream of rays has no negative length");
  TraceCounts unread;
  (choose_variant(options.isa).loops.*loop)(
      world.impl().view, rays, settings_of(options.packet), counts ? *counts : unread);
}

Hit trace(const World& world, const Ray& r, Loop VariantLoops::*loop) {
  Hit hit{r.t_max};
  const RaySpan one{
      &r.org.x, &r.org.y, &r.org.z, &r.dir.x, &r.dir.y, &r.dir.z, &r.t_min, &hit.t, &hit.id, 1};
  trace(world, one, {.packet = 1}, nullptr, loop);
  return hit;
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
  return trace(world, ray, &VariantLoops::closest);
}

void occluded(const World& world,
              const RaySpan& rays,
              const QueryOptions& options,
              TraceCounts* counts) {
  trace(world, rays, options, counts, &VariantLoops::occluded);
}
bool occluded(const World& world, const Ray& ray) {
  return bool(trace(world, ray, &VariantLoops::occluded));
}

SurfacePoint surface(const World& world, const Ray& ray, const Hit& hit) {
  assert(hit);
  const World::Impl& w = world.impl();
  const scalar::Surface<float> s = scalar::surface_of<float>(
      w.view.geometry, hit.id, vec(ray.org), vec(ray.dir), hit.t, w.shading.smooth);
  return {float3(s.point), float3(s.normal), float3(s.shading), s.away, s.material};
}

Float3 SurfacePoint::leave(Float3 dir) const {
  return float3(scalar::leave(vec(point), vec(normal), away, vec(dir)));
}

Primitive primitive_of(const World& world, std::uint32_t id) {
  const PrimitiveIds& ids = world.impl().primitives.ids;
  assert(id < ids.end());
  return ids.primitive(id);
}

}  // namespace grelha
