#pragma once
// All that is known of planes.

#include <cstddef>

#include "grelha/scene_spans.hpp"
#include "kernel/shapes/arrays.hpp"
#include "kernel/shapes/surface_position.hpp"
#include "kernel/shapes/hit.hpp"
#include "kernel/base/vec3.hpp"

namespace grelha {

/// A kind of primitive. It stands in no grid: every ray is tested against every plane.
struct Plane {
  static constexpr PrimitiveKind kKind = PrimitiveKind::kPlane;
  static constexpr bool kFinite = false;
  static constexpr bool kPositionFromRay = true;  ///< a surface is found without t

  /// A plane as tests read it; or many, an array per field.
  template <class T>
  struct Fields {
    T point[3], normal[3];
  };
  template <class Visit, class... F>
  static constexpr void for_each_field(const Visit& visit, F&... of) {
    for_each_axis(visit, of.point...);
    for_each_axis(visit, of.normal...);
  }
  using Arrays = IndexedArrays<Fields<const float*>>;

  /// The caller's arrays of numbers.
  template <class Visit>
  static void for_each_array(const PlaneSpans& spans, const Visit& visit) {
    for (const Floats* v : {&spans.x, &spans.y, &spans.z, &spans.nx, &spans.ny, &spans.nz})
      visit(*v);
  }
  static const PlaneSpans& spans_of(const GeometrySpans& g) { return g.planes; }
  /// True if all arrays have the same length.
  static bool is_even(const PlaneSpans& spans) {
    bool even = spans.material.size() == spans.size();
    for_each_array(spans, [&](Floats v) { even &= v.size() == spans.size(); });
    return even;
  }
  static std::size_t bytes(const PlaneSpans& spans) { return spans.size() * 7 * sizeof(float); }

  /// The caller's planes.
  struct Source {
    static constexpr std::size_t kSetupBytes = 0;  ///< a plane
    PlaneSpans spans;
    explicit Source(const GeometrySpans& g) : spans(g.planes) {}
    std::size_t size() const { return spans.size(); }
    Fields<const float*> fields() const {
      return {{spans.x.data(), spans.y.data(), spans.z.data()},
              {spans.nx.data(), spans.ny.data(), spans.nz.data()}};
    }
    Arrays arrays() const {
      return {
          fields(),
          spans.material.data(),
          static_cast<std::uint32_t>(size()),
      };
    }
    Fields<float> operator[](std::size_t i) const { return one_of<Plane>(fields(), i); }
  };
};

}  // namespace grelha

namespace grelha::GRELHA_ISA {

/// Bounds the crossings of rays and infinite planes in a precision, from either side; parallel rays
/// do not cross. docs/proofs.md derives the bounds: 4 u of its terms for the product with the
/// direction, 5 u for the product with the way to the point; 8 u are used here.
template <class Real>
[[gnu::always_inline]] inline HitInterval<Real> bound(const SimdRays<Real>& ray,
                                                      const Plane::Fields<Real>& plane,
                                                      const Real& best) {
  const Vec3<Real> n = vec(plane.normal);
  const Vec3<Real> to = ray.to(vec(plane.point));
  const Real along = dot(ray.dir, n);
  const Real inverse = Real(1) / along;
  const Real t = dot(to, n) * inverse;
  const Real error_bound = units<Real>(8) * dot(sizes(ray.dir), sizes(n)) +
                           Real(static_cast<Scalar<Real>>(kUnderflow<Real>));
  const Real slack =
      (units<Real>(16) * dot(sizes(to), sizes(n)) + Real(2) * (magnitude(t) * error_bound)) *
          magnitude(inverse) +
      Real(static_cast<Scalar<Real>>(kUnderflow<Real>));
  const Real lo = t - slack;
  const Real hi = t + slack;
  const Mask<Real> known = magnitude(along) > Real(2) * error_bound;
  const Mask<Real> some = and_not(t == t, mask_and(known, mask_or(hi <= ray.t_min, lo > best)));
  return {some, mask_and(some, mask_and(known, lo > ray.t_min)), lo, hi};
}

inline ExactCrossing exact_crossing(const ExactRay& ray, const Plane::Fields<float>& plane) {
  return cross_plane(ray, plane.point, plane.normal);
}

/// Through `through`, across `across`, of any length.
template <class Real>
inline SurfacePosition<Real> plane_position(const Vec3<Real>& through,
                                            const Vec3<Real>& across,
                                            const Vec3<Real>& at) {
  const Vec3<Real> n = normalize(across);
  return {at - dot(at - through, n) * n, n, Real(8 * kEps) * (largest(at) + largest(through))};
}

/// Surfaces of planes i at the rays' hits.
template <class Real>
inline Surface<Real> surface_on(const Plane::Arrays& planes,
                                const Words<Real>& i,
                                const SurfaceHit<Real>& met) {
  const auto plane = gathered<Plane, Real>(planes.fields, i);
  const Vec3<Real> p = vec(plane.point);
  const Vec3<Real> n = vec(plane.normal);
  const Real t = dot(p - met.org, n) / dot(met.dir, n);
  const Vec3<Real> at = met.first ? met.org + t * met.dir : met.at;
  return surface_at<Real>(plane_position<Real>(p, n, at), words_at(planes.material, i));
}

}  // namespace grelha::GRELHA_ISA
