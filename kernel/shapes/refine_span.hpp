#pragma once
// Crossings that floats cannot decide are decided by doubles, and the rest by exact numbers.

#include "kernel/shapes/simd_rays.hpp"

namespace grelha {

/// t of a crossing, from lo to hi; NaN: there is none.
struct CrossingSpan {
  float lo = __builtin_nanf("");
  float hi = __builtin_nanf("");
};

}  // namespace grelha

namespace grelha::GRELHA_ISA {

/// One ray in double.
inline SimdRays<double> in_double(const ExactRay& r) {
  const Vec3<double> dir = vec(r.dir);
  const double inv_dd = 1 / dot(dir, dir);
  return {.org = vec(r.org),
          .dir = dir,
          .inv_dd = inv_dd,
          .inv_length = inverse_length(dir, inv_dd),
          .t_min = r.t_min,
          .frame_error = 0,
          .error_bound = __builtin_inf()};
}

/// Part i of rays as they came, in double.
template <int i, class Real>
[[gnu::always_inline]] inline SimdRays<Wide<Real>> given_in_double(const SimdRays<Real>& ray) {
  using W = Wide<Real>;
  const auto given = [&](const float* of) {
    of += ray.first;
    return ray.step == 0 ? W(static_cast<double>(*of)) : take<W>(of + i * kWidth<W>);
  };
  const auto of = [&](const auto& member, const Real& own) {
    return ray.base ? given(member(*ray.given)) : to_double<i>(own);
  };
  const auto t_min = [&] {
    if (ray.given && ray.given->unit)
      return given(ray.given->unit) * given(ray.given->t_min);
    return of([](const GivenRays& g) { return g.t_min; }, ray.t_min);
  };
  const auto origin = [](int axis) { return [axis](const GivenRays& g) { return g.org[axis]; }; };
  const Vec3<W> dir = to_double<i>(ray.dir);
  const W inv_dd = W(1) / dot(dir, dir);
  return {.org = {of(origin(0), ray.org.x), of(origin(1), ray.org.y), of(origin(2), ray.org.z)},
          .dir = dir,
          .inv_dd = inv_dd,
          .inv_length = inverse_length(dir, inv_dd),
          .t_min = t_min(),
          .frame_error = W(0),
          .error_bound = W(0)};
}
/// t of the rays as given minus t of the tested rays.
template <int i, class Real>
[[gnu::always_inline]] inline Wide<Real> shift_in_double(const SimdRays<Real>& ray) {
  using W = Wide<Real>;
  if (!ray.base)
    return W(0);
  return ray.step == 0 ? W(ray.given->shift[ray.first])
                       : load<W>(ray.given->shift + ray.first + i * kWidth<W>);
}
/// Moves a double by more than 2 u and the least float: it rounds to a float not above, or not
/// below.
template <class W>
[[gnu::always_inline]] inline W rounded_down(const W& a) {
  return a - (magnitude(a) * W(0x1p-23) + W(0x1p-149));
}
template <class W>
[[gnu::always_inline]] inline W rounded_up(const W& a) {
  return a + (magnitude(a) * W(0x1p-23) + W(0x1p-149));
}

/// Upper and lower bounds of t, counted from `shift` on: doubles round the difference by 2^-53 of
/// itself.
inline float round_t_up(double t, double shift) {
  return round_up((t - shift) + magnitude(t - shift) * 0x1p-52);
}
inline float round_t_down(double t, double shift) {
  return round_down((t - shift) - magnitude(t - shift) * 0x1p-52);
}

/// Floats around [lo, hi], t being counted from `shift` on.
inline CrossingSpan span_from(double lo, double hi, double shift) {
  return {round_t_down(lo, shift), round_t_up(hi, shift)};
}
inline CrossingSpan span_of(const ExactCrossing& crossing, double shift) {
  const double t = crossing.estimate();
  return span_from(t - magnitude(t) * 0x1p-48, t + magnitude(t) * 0x1p-48, shift);
}

/// The span of a crossing from doubles, or else from cross(); t is counted from `shift` on.
template <class Cross>
inline CrossingSpan refine_span(const HitInterval<double>& found,
                                double shift,
                                const Cross& cross) {
  if (!found.some)
    return {};
  if (found.sure)
    return span_from(found.lo, found.hi, shift);
  const ExactCrossing exact = cross();
  return exact.some() ? span_of(exact, shift) : CrossingSpan{};
}

/// Replaces selected lanes of `found` by span_of(lane).
template <class Real, class SpanOf>
inline void replace_selected(unsigned selected, HitInterval<Real>& found, const SpanOf& span_of) {
  Scalar<Real> lo[kWidth<Real>], hi[kWidth<Real>];
  store(lo, found.lo);
  store(hi, found.hi);
  each_bit(selected, [&](int k) {
    const CrossingSpan span = span_of(k);
    lo[k] = span.lo;
    hi[k] = span.hi;
  });
  load(lo, found.lo);
  load(hi, found.hi);
  found.some = mask_and(found.some, found.hi == found.hi);
}

}  // namespace grelha::GRELHA_ISA
