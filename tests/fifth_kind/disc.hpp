#pragma once
// All that is known of discs.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "grelha/scene_spans.hpp"
#include "kernel/shapes/plane.hpp"
#include "kernel/shapes/sphere.hpp"

namespace grelha {

/// A kind of primitive: what of a plane lies around a point.
struct Disc {
  static constexpr PrimitiveKind kKind = PrimitiveKind::kDisc;
  static constexpr bool kFinite = true;
  static constexpr bool kInBlocks = false;

  /// The fields that intersection tests read: of one disc, or arrays of these fields.
  template <class T>
  struct Fields {
    T center[3], normal[3];  ///< normal: unit
    T radius;
  };
  template <class Visit, class... F>
  static constexpr void for_each_field(const Visit& visit, F&... of) {
    for_each_axis(visit, of.center...);
    for_each_axis(visit, of.normal...);
    visit(of.radius...);
  }
  using Arrays = IndexedArrays<Fields<const float*>>;
  using CellList = CellArrays<Fields<const float*>>;

  /// The caller's arrays of numbers.
  template <class Visit>
  static void for_each_array(const DiscSpans& s, const Visit& visit) {
    for (const Floats* v : {&s.x, &s.y, &s.z, &s.nx, &s.ny, &s.nz, &s.radius})
      visit(*v);
  }
  static const DiscSpans& spans_of(const GeometrySpans& g) { return g.discs; }
  /// Returns true if all arrays have the same length.
  static bool is_even(const DiscSpans& spans) {
    bool even = true;
    for_each_array(spans, [&](Floats v) { even &= v.size() == spans.size(); });
    return even;
  }
  static std::size_t bytes(const DiscSpans& spans) { return spans.size() * 8 * sizeof(float); }

  /// The caller's discs, with normals of unit length.
  struct Source {
    static constexpr std::size_t kSetupBytes = 3 * sizeof(float);  ///< a disc
    DiscSpans spans;
    std::vector<float> normal[3];
    explicit Source(const GeometrySpans& g) : spans(g.discs) {
      for (std::size_t i = 0; i < spans.size(); ++i) {
        const double n[3] = {spans.nx[i], spans.ny[i], spans.nz[i]};
        const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int a = 0; a < 3; ++a)
          normal[a].push_back(static_cast<float>(n[a] / length));
      }
    }
    std::size_t size() const { return spans.size(); }
    Fields<const float*> fields() const {
      return {{spans.x.data(), spans.y.data(), spans.z.data()},
              {normal[0].data(), normal[1].data(), normal[2].data()},
              spans.radius.data()};
    }
    Arrays arrays() const {
      return {fields(), spans.material.data(), static_cast<std::uint32_t>(size())};
    }
    Fields<float> operator[](std::size_t i) const { return one_of<Disc>(fields(), i); }
  };

  /// Across a unit axis d it reaches r sqrt(1 - d_a^2); 1e-6: what rounding took from d.
  static Box box(const Source& source, std::size_t i) {
    const Fields<float> disc = source[i];
    Box b;
    for (int a = 0; a < 3; ++a) {
      const double d = disc.normal[a];
      const double half_width = disc.radius * std::sqrt(std::max(0., 1 - d * d) + 1e-6);
      b.lo[a] = disc.center[a] - half_width;
      b.hi[a] = disc.center[a] + half_width;
    }
    return b;
  }

  /// A cell grown by pad against the disc's plane.
  class Overlap {
   public:
    Overlap(const Fields<float>& disc, const CellFrame& g, const CellRange&) {
      reach_ = 0;
      for (int a = 0; a < 3; ++a) {
        normal_[a] = disc.normal[a];
        first_[a] = g.lo[a] + g.cell[a] / 2 - disc.center[a];
        cell_[a] = g.cell[a];
        reach_ += std::abs(normal_[a]) * (g.cell[a] / 2 + g.pad);
      }
    }
    bool operator()(const int (&at)[3]) const {
      double away = 0;
      for (int a = 0; a < 3; ++a)
        away += normal_[a] * (first_[a] + at[a] * cell_[a]);
      return std::abs(away) <= reach_ * (1 + 1e-12);
    }

   private:
    double normal_[3], first_[3], cell_[3], reach_;
  };
};

}  // namespace grelha

namespace grelha::GRELHA_ISA {

/// What a precision tells of rays and discs, from either side; rays along one do not cross. Way and
/// place are taken from the ray's point nearest to the center: what is large cancels once. They are
/// off by 16 u w, w = |center - org| / |cosine of the angle between ray and normal|.
template <class Real>
[[gnu::always_inline]] inline HitInterval<Real> bound(const SimdRays<Real>& ray,
                                                      const Disc::Fields<Real>& disc,
                                                      const Real& best) {
  const Vec3<Real> normal = vec(disc.normal);
  const Vec3<Real> to_center = ray.to(vec(disc.center));
  const Real middle = dot(to_center, ray.dir) * ray.inv_dd;
  const Vec3<Real> gap = middle * ray.dir - to_center;
  const Real along = dot(ray.dir, normal);
  const Real rest = (Real(0) - dot(gap, normal)) / along;
  const Vec3<Real> from_center = gap + rest * ray.dir;
  const Real t = middle + rest;
  const Vec3<Real> size = sizes(to_center);
  const Real far = ((size.x + size.y) + size.z) + disc.radius;
  const Real cosine = magnitude(along) * ray.inv_length;
  const Real error_bound = (units<Real>(32) * far + Real(8) * ray.frame_error) / cosine;
  const Real lo = t - error_bound * ray.inv_length;
  const Real hi = t + error_bound * ray.inv_length;
  const Mask<Real> known = cosine > units<Real>(64);
  const Real outer = disc.radius + error_bound;
  const Real inner = disc.radius - error_bound;
  const Mask<Real> beside = dot(from_center, from_center) > outer * outer;
  const Mask<Real> never = mask_or(beside, mask_or(hi <= ray.t_min, lo > best));
  const Mask<Real> some = and_not(disc.radius == disc.radius, mask_and(known, never));
  const Mask<Real> within =
      mask_and(inner > Real(0), dot(from_center, from_center) < inner * inner);
  return {some, mask_and(mask_and(some, known), mask_and(within, lo > ray.t_min)), lo, hi};
}

/// With 106 bits.
inline ExactCrossing exact_crossing(const ExactRay& ray, const Disc::Fields<float>& disc) {
  const auto& [c, n, radius] = disc;
  const WideVector to_center{DoubleDouble(c[0]) - ray.org[0],
                             DoubleDouble(c[1]) - ray.org[1],
                             DoubleDouble(c[2]) - ray.org[2]};
  const WideVector dir{ray.dir[0], ray.dir[1], ray.dir[2]};
  const WideVector normal{n[0], n[1], n[2]};
  const DoubleDouble along = dot(dir, normal);
  if (along.high == 0)
    return {};
  const DoubleDouble t = dot(to_center, normal) / along;
  const WideVector from_center = t * dir - to_center;
  const bool within = !(dot(from_center, from_center) > DoubleDouble(radius) * radius);
  return within && t > ray.t_min ? ExactCrossing(t) : ExactCrossing();
}

/// Lanes of discs i, i + 1, ... whose balls overlap a frustum.
template <class Frustum>
inline unsigned overlapping(const Frustum& f, const FieldArrays<Disc>& discs, std::uint32_t i) {
  const auto& [x, y, z] = discs.center;
  return overlapping(f, FieldArrays<Sphere>{{x, y, z}, discs.radius}, i);
}

/// Groups of rays in a frustum that may hit a disc's ball.
template <class Frustum>
inline std::uint64_t groups_near(const Frustum& f, const Disc::Fields<float>& disc) {
  const auto& [x, y, z] = disc.center;
  return groups_near(f, Sphere::Fields<float>{{x, y, z}, disc.radius});
}

/// Computes the surface points of hits on discs with indices i, as for hits on planes.
template <class Real>
inline Surface<Real> surface_on(const Disc::Arrays& discs,
                                const Words<Real>& i,
                                const SurfaceHit<Real>& met) {
  const auto disc = gathered<Disc, Real>(discs.fields, i);
  const Vec3<Real> c = vec(disc.center);
  const Vec3<Real> n = vec(disc.normal);
  return surface_at<Real>(plane_position<Real>(c, n, met.at), words_at(discs.material, i));
}

inline Vec3<double> normal_at(const Vec3<double>&, const Disc::Fields<float>& disc) {
  return normalize(Vec3<double>{disc.normal[0], disc.normal[1], disc.normal[2]});
}
/// The nearest point of a disc: in its plane, moved to its rim if it lies beyond.
inline Vec3<double> nearest_on(const Vec3<double>& p, const Disc::Fields<float>& disc) {
  const Vec3<double> center{disc.center[0], disc.center[1], disc.center[2]};
  const Vec3<double> n = normal_at(p, disc);
  const Vec3<double> across = (p - center) - dot(p - center, n) * n;
  const double distance = length(across);
  const double radius = disc.radius;
  return center + (distance > radius ? radius / distance : 1.) * across;
}
}  // namespace grelha::GRELHA_ISA
