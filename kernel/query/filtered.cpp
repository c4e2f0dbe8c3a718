#include "kernel/query/filtered.hpp"

#include "kernel/query/hit_list.hpp"
#include "kernel/shapes/triangle_surface.hpp"

namespace grelha {
namespace {

/// Barycentric coordinates where a ray crosses a triangle, in double.
std::pair<float, float> barycentric(const Triangle::Fields<float>& triangle, const Ray& ray) {
  using Vector = scalar::Vec3<double>;
  const Vector org{ray.org.x, ray.org.y, ray.org.z};
  const Vector dir{ray.dir.x, ray.dir.y, ray.dir.z};
  const auto& c = triangle.corner;
  const auto corner = [&](int k) { return Vector{c[k][0], c[k][1], c[k][2]}; };
  const Vector weights = scalar::triangle_position<double>(
                             scalar::shear_axes(dir), org, dir, {corner(0), corner(1), corner(2)})
                             .weights;
  const auto u = static_cast<float>(weights.y);
  const auto v = static_cast<float>(weights.z);
  return {u, u + v > 1 ? 1 - u : v};
}

/// t of a hit, as Hits::t_double has it.
double double_t_of(const SceneView& scene, const Ray& ray, const Hit& hit) {
  if (!hit)
    return ray.t_max;
  const PreparedRay prepared(scene, ray);
  const double unit = 1 / static_cast<double>(prepared.unit);
  return double_t(scene.geometry, prepared.exact().in_units_of(unit), hit.id);
}

}  // namespace

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

Hit filtered(const World& world, const Ray& ray, const Filter& filter, const Hit& closest) {
  if (!closest || passes(filter, closest.id))
    return closest;
  const std::vector<Hit> hits = HitList(world, filter).find(ray);
  return hits.empty() ? Hit{ray.t_max, kNoPrimitive} : hits.front();
}

FilteredClosest::FilteredClosest(const World& world,
                                 const Rays& rays,
                                 const Hits& hits,
                                 const QueryOptions& options)
    : world_(world), rays_(rays), hits_(hits), options_(options), found_(rays.count) {}

void FilteredClosest::trace(ClosestLoop loop, const TraceOptions& how, TraceCounts& counts) {
  const SceneView& scene = world_.impl().view;
  Hits all = Hits::of(found_);
  all.t_double = hits_.t_double;
  loop(scene, rays_, all, how, counts);
  for (std::size_t i = 0; i < rays_.count; ++i) {
    const Ray ray = ray_of(rays_, i);
    const Hit hit = filtered(world_, ray, filter_of(rays_, options_, i), found_[i]);
    if (hits_.t_double && hit.id != found_[i].id)
      hits_.t_double[i] = double_t_of(scene, ray, hit);
    const bool on_triangle = hit && scene.geometry.ids.has(PrimitiveKind::kTriangle, hit.id);
    std::pair<float, float> at{0, 0};
    if (on_triangle && (hits_.u || hits_.v))
      at = barycentric(scene.geometry.of<Triangle>().triangle(
                           hit.id - scene.geometry.ids.begin(PrimitiveKind::kTriangle)),
                       ray);
    store(i, hit, at);
  }
}

void FilteredClosest::store(std::size_t i, const Hit& hit, const std::pair<float, float>& at) {
  const std::ptrdiff_t to = static_cast<std::ptrdiff_t>(i) * hits_.stride;
  if (hits_.t)
    hits_.t[to] = hit.t;
  if (hits_.id)
    hits_.id[to] = hit.id;
  if (hits_.u)
    hits_.u[i] = at.first;
  if (hits_.v)
    hits_.v[i] = at.second;
}

}  // namespace grelha
