#pragma once
// What no float tells of hits: where one is, which of two is first. Doubles are asked, and then
// exact numbers.

#include "kernel/shapes/geometry_view.hpp"

namespace grelha {

/// The span of t of the first crossing beyond t_min of a ray and one primitive of a kind, whose
/// Fields<float> are given, in t - shift.
CrossingSpan crossing_span(PrimitiveKind kind,
                           const ExactRay& ray,
                           const void* fields,
                           double shift);
/// The same of the primitive `id`.
CrossingSpan crossing_span(const GeometryView& g,
                           const ExactRay& ray,
                           std::uint32_t id,
                           double shift);

/// Which of two primitives a ray that crosses both beyond t_min crosses first; of equal t the lower
/// id.
bool comes_first(const GeometryView& g, const ExactRay& ray, std::uint32_t id, std::uint32_t other);
/// Whether a ray crosses a primitive, which it does beyond t_min, before t_max.
bool comes_before(const GeometryView& g, const ExactRay& ray, std::uint32_t id, float t_max);
/// t of that crossing, within 2^-45 of itself.
double double_t(const GeometryView& g, const ExactRay& ray, std::uint32_t id);
/// The same rounded once.
float rounded_t(const GeometryView& g, const ExactRay& ray, std::uint32_t id);

}  // namespace grelha

namespace grelha::GRELHA_ISA {

/// Replaces chosen lanes of what floats found.
template <class Shape, class Real>
[[gnu::noinline, gnu::cold]] void settle(const RayLanes<Real>& ray,
                                         const typename Shape::template Fields<Real>& primitive,
                                         const Mask<Real>& chosen,
                                         Found<Real>& found) {
  using One = typename Shape::template Fields<float>;
  float field[sizeof(One) / sizeof(float)][kWidth<Real>];
  int count = 0;
  Shape::for_each_field([&](const Real& x) { store(field[count++], x); }, primitive);
  replace_lanes(bits(chosen), found, [&](int k) {
    One one;
    int next = 0;
    Shape::for_each_field([&](float& x) { x = field[next++][k]; }, one);
    const int at = ray.first + k * ray.step;
    return crossing_span(Shape::kKind, ray.given->ray(at), &one, ray.given->shift_of(at));
  });
}

/// Where rays cross primitives: lanes whose ray does so at a t beyond t_min, which is from lo to
/// hi. Those whose t is surely beyond `best` are left out.
template <class Shape, class Real>
[[gnu::always_inline]] inline Found<Real> meet(
    const RayLanes<Real>& ray,
    const typename Shape::template Fields<Real>& primitive,
    const Real& best) {
  Found<Real> found = bound(ray, primitive, best);
  const Mask<Real> unsure = but_not(found.some, found.sure);
  if (any(unsure)) [[unlikely]]
    settle<Shape>(ray, primitive, unsure, found);
  return found;
}

}  // namespace grelha::GRELHA_ISA
