#pragma once
// Decides what floats cannot: where a hit is, and which of two hits is first. Doubles are tried
// first, then exact numbers.

#include "kernel/shapes/geometry_view.hpp"

namespace grelha {

/// The span of t - shift of the first crossing beyond t_min of a ray and one primitive of a kind,
/// with the given Fields<float>.
CrossingSpan crossing_span(PrimitiveKind kind,
                           const ExactRay& ray,
                           const void* fields,
                           double shift);
/// The same for the primitive `id`.
CrossingSpan crossing_span(const GeometryView& g,
                           const ExactRay& ray,
                           std::uint32_t id,
                           double shift);

/// t of the first crossing of a ray and a primitive beyond t_min: surely none unless `some`, and
/// surely one from lo to hi if `sure`. By doubles alone.
struct CrossingBounds {
  bool some, sure;
  double lo, hi;
};
CrossingBounds crossing_bounds(const GeometryView& g, const ExactRay& ray, std::uint32_t id);
/// The same crossing, exactly.
ExactCrossing crossing_of(const GeometryView& g, const ExactRay& ray, std::uint32_t id);

/// True if a ray that crosses two primitives beyond t_min crosses `id` first; of equal t the lower
/// id is first. `first`: the span of t - shift of the first of the two.
bool is_closest(const GeometryView& g,
                const ExactRay& ray,
                std::uint32_t id,
                std::uint32_t other,
                double shift,
                CrossingSpan& first);
/// True if a ray along an axis, which crosses two triangles, does so at a vertex or an edge that
/// both have, at one t.
bool meet_on_axis(const GeometryView& g,
                  const ExactRay& ray,
                  std::uint32_t id,
                  std::uint32_t other);
/// True if a ray crosses a primitive before t_max, given that it crosses it beyond t_min.
bool is_before_end(const GeometryView& g, const ExactRay& ray, std::uint32_t id);
/// Barycentric coordinates where a ray crosses a triangle, given that it does: those of Hits.
struct Barycentric {
  float u = 0, v = 0;
};
Barycentric barycentric(const GeometryView& g, const ExactRay& ray, std::uint32_t id);
/// t of the first crossing, within 2^-45 of itself.
double double_t(const GeometryView& g, const ExactRay& ray, std::uint32_t id);
/// The same rounded once; faster for a sphere if `span` holds it.
float rounded_t(const GeometryView& g,
                const ExactRay& ray,
                std::uint32_t id,
                const CrossingSpan& span = {});

}  // namespace grelha

namespace grelha::GRELHA_ISA {

/// Replaces the selected lanes of crossings that floats found.
template <class Shape, class Real>
[[gnu::noinline, gnu::cold]] void settle(const SimdRays<Real>& ray,
                                         const typename Shape::template Fields<Real>& primitive,
                                         const Mask<Real>& selected,
                                         HitInterval<Real>& found) {
  using One = typename Shape::template Fields<float>;
  float field[sizeof(One) / sizeof(float)][kWidth<Real>];
  int count = 0;
  Shape::for_each_field([&](const Real& x) { store(field[count++], x); }, primitive);
  replace_selected(bits(selected), found, [&](int k) {
    One one;
    int next = 0;
    Shape::for_each_field([&](float& x) { x = field[next++][k]; }, one);
    const int at = ray.first + k * ray.step;
    return crossing_span(Shape::kKind, ray.given->ray(at), &one, ray.given->shift_of(at));
  });
}

/// Finds crossings of rays and primitives: lanes whose ray crosses at a t beyond t_min, which is
/// from lo to hi. Lanes whose t is surely beyond `best` are left out.
template <class Shape, class Real>
[[gnu::always_inline]] inline HitInterval<Real> intersect(
    const SimdRays<Real>& ray,
    const typename Shape::template Fields<Real>& primitive,
    const Real& best) {
  HitInterval<Real> found = bound(ray, primitive, best);
  const Mask<Real> unsure = and_not(found.some, found.sure);
  if (any(unsure)) [[unlikely]]
    settle<Shape>(ray, primitive, unsure, found);
  return found;
}

}  // namespace grelha::GRELHA_ISA
