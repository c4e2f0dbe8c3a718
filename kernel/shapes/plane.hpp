#pragma once
// All that is known of planes.

#include <cstddef>

#include "grelha/scene_spans.hpp"
#include "kernel/shapes/surface_place.hpp"
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
    for (int a = 0; a < 3; ++a)
      visit(of.point[a]...);
    for (int a = 0; a < 3; ++a)
      visit(of.normal[a]...);
  }

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
    Fields<float> operator[](std::size_t i) const {
      return {{spans.x[i], spans.y[i], spans.z[i]}, {spans.nx[i], spans.ny[i], spans.nz[i]}};
    }
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
inline Surface<Real> surface_on(Plane,
                                const GeometryView& g,
                                const Words<Real>& i,
                                const Meeting<Real>& met) {
  const Vec3<Real> p = three_at(g.px, g.py, g.pz, i), n = three_at(g.pnx, g.pny, g.pnz, i);
  return surface_at<Real>(
      met,
      [&] { return plane_place<Real>(p, n, met.at); },
      [&](auto k, const auto& here) { return plane_place(widen<k>(p), widen<k>(n), here); },
      words_at(g.plane_material, i));
}

}  // namespace grelha::GRELHA_ISA
