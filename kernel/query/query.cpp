#define GRELHA_ISA scalar
#include "grelha/query.hpp"

#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>

#include "kernel/query/streams.hpp"
#include "kernel/query/variants.hpp"
#include "kernel/shapes/nearest.hpp"
#include "kernel/shapes/surface.hpp"
#include "kernel/world/world_impl.hpp"

namespace grelha {
namespace {

/// As each_run(), with counts of work that are added up.
template <class Trace>
void counted_runs(std::size_t count,
                  const QueryOptions& options,
                  TraceCounts& counts,
                  const Trace& trace) {
  if (options.threads == 1 && !options.progress) {  // short streams ask for no std::function
    trace(std::size_t{0}, count, counts);
    return;
  }
  std::mutex mutex;
  each_run(count, options, [&](std::size_t first, std::size_t end) {
    TraceCounts own;
    trace(first, end, own);
    const std::lock_guard lock(mutex);
    counts += own;
  });
}

void expect_primitive(const PrimitiveIds& ids, std::uint32_t id) {
  if (id >= ids.end())
    throw std::invalid_argument("no primitive of this scene has this id");
}

/// Throws std::invalid_argument for numbers that no point of a triangle has, even rounded.
void expect_barycentric(double u, double v) {
  constexpr double kRounded = 1e-6;
  if (!(u >= -kRounded && v >= -kRounded && u + v <= 1 + kRounded))
    throw std::invalid_argument("u, v: expected 0 or more, together at most 1, found " +
                                std::to_string(u) + " and " + std::to_string(v));
}

scalar::Vec3<float> vec(const Float3& p) {
  return {p.x, p.y, p.z};
}
Float3 float3(const scalar::Vec3<float>& v) {
  return {v.x, v.y, v.z};
}

scalar::Vec3<float> narrowed(const scalar::Point& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// What a ray that hits nothing sees.
SurfacePoint no_surface() {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  return {{kNone, kNone, kNone}, {}, {}, 0, 0};
}

}  // namespace

void closest(const World& world,
             const Rays& rays,
             const Hits& hits,
             const QueryOptions& options,
             TraceCounts* counts) {
  expect_arrays(rays);
  expect_masks(world, options.mask);
  TraceCounts unread;
  const ClosestLoop loop = choose_variant(options.isa, rays.count).loops.closest;
  const TraceOptions how = options_of(options);
  const auto trace = [&](std::size_t first, std::size_t end, TraceCounts& to) {
    loop(world.impl().view, rays.part(first, end), part_of(hits, first), how, to);
  };
  counted_runs(rays.count, options, counts ? *counts : unread, trace);
}
void closest(const World& world,
             std::span<const Ray> rays,
             std::span<Hit> hits,
             const QueryOptions& options,
             TraceCounts* counts) {
  expect_same_size(rays.size(), hits.size(), "rays");
  closest(world, Rays::of(rays), Hits::of(hits), options, counts);
}
Hit closest(const World& world, const Ray& ray) {
  return best_variant().loops.closest_one(world.impl().view, ray, nullptr);
}
Hit closest(const World& world, const Ray& ray, const Filter& filter) {
  expect_masks(world, filter.masks);
  return best_variant().loops.closest_one(world.impl().view, ray, &filter);
}

void occluded(const World& world,
              const Rays& rays,
              std::uint8_t* blocked,
              const QueryOptions& options,
              TraceCounts* counts) {
  expect_arrays(rays);
  expect_masks(world, options.mask);
  if (!blocked && rays.count > 0)
    throw std::invalid_argument("occluded: expected an array of answers, found null");
  TraceCounts unread;
  const OccludedLoop loop = choose_variant(options.isa, rays.count).loops.occluded;
  const TraceOptions how = options_of(options);
  const auto trace = [&](std::size_t first, std::size_t end, TraceCounts& to) {
    loop(world.impl().view, rays.part(first, end), blocked + first, how, to);
  };
  counted_runs(rays.count, options, counts ? *counts : unread, trace);
}
void occluded(const World& world,
              std::span<const Ray> rays,
              std::span<std::uint8_t> blocked,
              const QueryOptions& options,
              TraceCounts* counts) {
  expect_same_size(rays.size(), blocked.size(), "rays");
  occluded(world, Rays::of(rays), blocked.data(), options, counts);
}
bool occluded(const World& world, const Ray& ray) {
  return best_variant().loops.occluded_one(world.impl().view, ray, nullptr);
}
bool occluded(const World& world, const Ray& ray, const Filter& filter) {
  expect_masks(world, filter.masks);
  return best_variant().loops.occluded_one(world.impl().view, ray, &filter);
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

SurfacePoint surface_at(const World& world, std::uint32_t id, Float3 point) {
  const World::Impl& w = world.impl();
  expect_primitive(w.primitives.ids, id);
  using scalar::Point;
  const Point p{point.x, point.y, point.z};
  Point foot{}, normal{};
  visit_primitive(w.view.geometry, id, [&]<class Shape>(const auto& one) {
    foot = nearest_on(p, one);
    normal = normal_at(foot, one);
  });
  // a short ray to that point
  const double away = length(foot) * 0x1p-10 + 0x1p-40;
  const Point from = foot + away * normal;
  const Point dir = (-away) * normal;
  const scalar::Vec3<float> org_f = narrowed(from), dir_f = narrowed(dir);
  return surface(world, {float3(org_f), float3(dir_f)}, {1, id});
}

SurfacePoint surface_at(const World& world, std::uint32_t id, double u, double v) {
  const World::Impl& w = world.impl();
  expect_primitive(w.primitives.ids, id);
  const Primitive primitive = w.primitives.ids.primitive(id);
  if (primitive.kind != PrimitiveKind::kTriangle)
    throw std::invalid_argument("id: expected a triangle, found " + std::to_string(id));
  expect_barycentric(u, v);
  const TriangleSpans& t = w.scene.geometry.triangles;
  const std::uint32_t a = t.a[primitive.index], b = t.b[primitive.index], c = t.c[primitive.index];
  const auto mixed = [&](Floats x) {
    return static_cast<float>((1 - u - v) * double{x[a]} + u * double{x[b]} + v * double{x[c]});
  };
  return surface_at(world, id, {mixed(t.x), mixed(t.y), mixed(t.z)});
}

void surfaces_at(const World& world,
                 std::span<const std::uint32_t> ids,
                 std::span<const float> u,
                 std::span<const float> v,
                 std::span<SurfacePoint> points,
                 const QueryOptions& options) {
  for (const std::size_t size : {u.size(), v.size(), points.size()})
    expect_same_size(ids.size(), size, "places");
  each_run(ids.size(), options, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i)
      points[i] =
          ids[i] == kNoPrimitive ? no_surface() : surface_at(world, ids[i], double{u[i]}, v[i]);
  });
}

void surfaces(const World& world,
              std::span<const Ray> rays,
              std::span<const Hit> hits,
              std::span<SurfacePoint> points,
              const QueryOptions& options) {
  expect_same_size(rays.size(), hits.size(), "rays");
  expect_same_size(rays.size(), points.size(), "rays");
  each_run(rays.size(), options, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i)
      points[i] = hits[i] ? surface(world, rays[i], hits[i]) : no_surface();
  });
}

Float3 SurfacePoint::start(Float3 dir) const {
  return float3(scalar::offset_origin(vec(point), vec(normal), offset, vec(dir)));
}

Primitive primitive_of(const World& world, std::uint32_t id) {
  const PrimitiveIds& ids = world.impl().primitives.ids;
  expect_primitive(ids, id);
  return ids.primitive(id);
}

}  // namespace grelha
