#include "kernel/query/hit_list.hpp"

#include <algorithm>
#include <cmath>

namespace grelha {

namespace {
constexpr double kSameCrossing =
    0x1p-45;  ///< times t: crossings of one primitive so near count as one
}  // namespace

bool HitList::block(const scalar::Single&, const TriangleBlock& block) {
  for (int i = 0; i < kBlock && block.id[i] != kNoPrimitive; ++i) {
    const Triangle::Fields<float> triangle = scalar::triangle_of(block, i);
    const scalar::HitInterval<double> found = scalar::bound_triangle(ray_, triangle.corner);
    if (found.some && !(found.lo >= ray_.t_max))  // NaN: double does not tell
      ids_.push_back(block.id[i]);
  }
  return false;
}

bool HitList::arrays(const scalar::Single&, const CellLists& lists, std::size_t cell) {
  each_in_arrays(lists, cell, [&](std::uint32_t id) { ids_.push_back(id); });
  return false;
}

ExactRay HitList::ray_from(double t_min) const {
  ExactRay ray = ray_;
  ray.t_min = t_min;
  return ray;
}

/// The crossings of a primitive, for each of its copies that passes.
void HitList::add_crossings(std::uint32_t id) {
  if (passes(filter_, id))
    add_crossings(id, id);
  const CopyTable& copies = world_.view.copies;
  for (std::uint32_t i = copies.begin(id); copies.has(i, id); ++i)
    if (passes(filter_, copies.pair[i].copy))
      add_crossings(id, copies.pair[i].copy);
}

void HitList::add_crossings(std::uint32_t id, std::uint32_t copy) {
  const GeometryView& g = world_.view.geometry;
  double t_min = ray_.t_min;
  // a ray crosses the side of a cone twice at most, a sphere twice, others once
  for (int left = 2; left > 0; --left) {
    const ExactRay ray = ray_from(t_min);
    CrossingBounds found = crossing_bounds(g, ray, id);
    if (!found.some || found.lo >= ray.t_max)
      return;
    if (!found.sure || found.hi >= ray.t_max) {
      const ExactCrossing exact = crossing_of(g, ray, id);
      if (!exact.some() || exact.compare(ray.t_max) >= 0)
        return;
      const double t = exact.estimate();
      found.lo = t - std::abs(t) * 0x1p-49;
      found.hi = t + std::abs(t) * 0x1p-49;
    }
    crossings_.push_back({copy, id, t_min, found.lo, found.hi});
    if (g.ids.has(PrimitiveKind::kTriangle, id) || g.ids.has(PrimitiveKind::kPlane, id))
      return;
    t_min = found.hi + std::abs(found.hi) * kSameCrossing;
  }
}

bool HitList::is_before(const Crossing& a, const Crossing& b) const {
  if (a.hi < b.lo || b.hi < a.lo)
    return a.hi < b.lo;
  if (a.original == b.original)
    return a.t_min != b.t_min ? a.t_min < b.t_min : a.id < b.id;
  const GeometryView& g = world_.view.geometry;
  const int order =
      crossing_of(g, ray_from(a.t_min), a.id).compare(crossing_of(g, ray_from(b.t_min), b.id));
  return order != 0 ? order < 0 : a.id < b.id;
}

const std::vector<Hit>& HitList::find(const Ray& ray) {
  hits_.clear();
  ids_.clear();
  crossings_.clear();
  PreparedRay prepared(world_.view, ray);
  if (!prepared.valid)
    return hits_;
  ray_ = prepared.exact();
  walk_scene(world_.view, prepared.single, *this);
  const PrimitiveIds& ids = world_.view.geometry.ids;
  for (std::uint32_t i = 0; i < world_.view.geometry.of<Plane>().count; ++i)
    ids_.push_back(ids.begin(PrimitiveKind::kPlane) + i);
  std::sort(ids_.begin(), ids_.end());
  ids_.erase(std::unique(ids_.begin(), ids_.end()), ids_.end());
  for (const std::uint32_t id : ids_)
    add_crossings(id);
  std::sort(crossings_.begin(), crossings_.end(), [this](const Crossing& a, const Crossing& b) {
    return is_before(a, b);
  });
  for (const Crossing& c : crossings_) {
    const float t = rounded_t(world_.view.geometry, prepared.given(ray_from(c.t_min)), c.id);
    hits_.push_back({scalar::strictly_between(t, ray.t_min, ray.t_max), c.id});
  }
  return hits_;
}

}  // namespace grelha
