#pragma once
// All that is known of planes.

#include <cstddef>

#include "grelha/scene_spans.hpp"
#include "kernel/primitive/arrays.hpp"
#include "kernel/primitive/surface_place.hpp"
#include "kernel/primitive/ray_lanes.hpp"
#include "kernel/simd/vec3.hpp"

namespace grelha {

/// A kind of primitive. It stands in no grid: every ray is tested against every plane.
struct Plane {
  static constexpr PrimitiveKind kKind = PrimitiveKind::kPlane;
  static constexpr bool kFinite = false;

  /// What tests see of a plane, or of many, an array each.
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
  /// Whether they have one length.
  static bool is_even(const PlaneSpans& spans) {
    bool even = true;
    for_each_array(spans, [&](Floats v) { even &= v.size() == spans.size(); });
    return even;
  }
  static std::size_t bytes(const PlaneSpans& spans) { return spans.size() * 7 * sizeof(float); }

  /// The caller's planes.
  struct Source {
    static constexpr std::size_t kPreparedBytes = 0;  ///< a plane
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

/// Point where each ray meets an infinite plane, from either side; parallel rays miss. Accuracy: t
/// within 6 eps (|point - org| |normal| / |dot(dir, normal)| + |t| (1 + 1 / sin)) of the exact one,
/// sin that of the angle between ray and plane (plane_test.cpp).
template <class Real>
[[gnu::always_inline]] inline Mask<Real> hit_plane(const Vec3<Real>& org,
                                                   const Vec3<Real>& dir,
                                                   const Real& t_min,
                                                   const Vec3<Real>& point,
                                                   const Vec3<Real>& normal,
                                                   Real& t) {
  const Real along = dot(dir, normal);
  t = dot(point - org, normal) / along;
  return both(along != Real(0), t > t_min);
}

template <class Real>
[[gnu::always_inline]] inline Mask<Real> meet(const RayLanes<Real>& ray,
                                              const Plane::Fields<Real>& plane,
                                              Real& t) {
  return hit_plane<Real>(ray.org, ray.dir, ray.t_min, vec(plane.point), vec(plane.normal), t);
}

/// Through `through`, across `across`, of any length.
template <class Real>
inline SurfacePlace<Real> plane_place(const Vec3<Real>& through,
                                      const Vec3<Real>& across,
                                      const Vec3<Real>& at) {
  const Vec3<Real> n = normalize(across);
  return {at - dot(at - through, n) * n,
          n,
          Real(8 * kRounding<Real>) * (largest(at) + largest(through))};
}

/// Where rays met planes, of indices i.
template <class Real>
inline Surface<Real> surface_on(const Plane::Arrays& planes,
                                const Words<Real>& i,
                                const Meeting<Real>& met) {
  const auto plane = gathered<Plane, Real>(planes.fields, i);
  const Vec3<Real> p = vec(plane.point);
  const Vec3<Real> n = vec(plane.normal);
  return surface_at<Real>(
      met,
      [&] { return plane_place<Real>(p, n, met.at); },
      [&](auto k, const auto& here) { return plane_place(widen<k>(p), widen<k>(n), here); },
      words_at(planes.material, i));
}

}  // namespace grelha::GRELHA_ISA
