#pragma once
// All that is known of spheres.

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "grelha/scene_spans.hpp"
#include "kernel/primitive/arrays.hpp"
#include "kernel/primitive/box.hpp"
#include "kernel/primitive/surface_place.hpp"
#include "kernel/primitive/ray_lanes.hpp"
#include "kernel/simd/vec3.hpp"

namespace grelha {

/// A kind of primitive, as the building of grids sees it; shapes.hpp says what each must have.
struct Sphere {
  static constexpr PrimitiveKind kKind = PrimitiveKind::kSphere;
  static constexpr bool kFinite = true;
  static constexpr bool kInBlocks = false;

  /// What tests see of a sphere, or of many, an array each.
  template <class T>
  struct Fields {
    T center[3], radius;
  };
  template <class Visit, class... F>
  static constexpr void for_each_field(const Visit& visit, F&... of) {
    for_each_axis(visit, of.center...);
    visit(of.radius...);
  }
  using Arrays = IndexedArrays<Fields<const float*>>;
  using CellList = CellArrays<Fields<const float*>>;

  /// The caller's arrays of numbers.
  template <class Visit>
  static void for_each_array(const SphereSpans& spans, const Visit& visit) {
    for (const Floats* v : {&spans.x, &spans.y, &spans.z, &spans.radius})
      visit(*v);
  }
  static const SphereSpans& spans_of(const GeometrySpans& g) { return g.spheres; }
  /// Whether they have one length.
  static bool is_even(const SphereSpans& spans) {
    bool even = spans.material.size() == spans.size();
    for_each_array(spans, [&](Floats v) { even &= v.size() == spans.size(); });
    return even;
  }
  static std::size_t bytes(const SphereSpans& spans) { return spans.size() * 5 * sizeof(float); }

  /// The caller's spheres.
  struct Source {
    static constexpr std::size_t kPreparedBytes = 0;  ///< a sphere
    SphereSpans spans;
    explicit Source(const GeometrySpans& g) : spans(g.spheres) {}
    std::size_t size() const { return spans.size(); }
    Fields<const float*> fields() const {
      return {{spans.x.data(), spans.y.data(), spans.z.data()}, spans.radius.data()};
    }
    Arrays arrays() const {
      return {
          fields(),
          spans.material.data(),
          static_cast<std::uint32_t>(size()),
      };
    }
    Fields<float> operator[](std::size_t i) const { return one_of<Sphere>(fields(), i); }
  };

  static Box box(const Source& source, std::size_t i) {
    const Fields<float> s = source[i];
    const double radius = s.radius < 0 ? -s.radius : s.radius;
    Box b;
    for (int a = 0; a < 3; ++a) {
      const double center = s.center[a];
      b.lo[a] = center - radius;
      b.hi[a] = center + radius;
    }
    return b;
  }

  /// A cell grown by pad against a ball's surface: nearest point inside, farthest outside. Doubles
  /// round by a thousandth of the pad and less.
  class Touch {
   public:
    Touch(const Fields<float>& s, const CellFrame& g, const CellRange&) {
      const double radius = std::abs(static_cast<double>(s.radius));
      for (int a = 0; a < 3; ++a) {
        cell_[a] = g.cell[a];
        center_[a] = s.center[a] - g.lo[a];
      }
      const double r = radius + g.pad;
      const double inner = radius - g.pad;
      reach_ = r * r;
      inner_ = inner > 0 ? inner * inner : -1;
    }
    bool operator()(const int (&at)[3]) const {
      double near = 0;
      double far = 0;
      for (int a = 0; a < 3; ++a) {
        const double lo = at[a] * cell_[a] - center_[a];
        const double hi = (at[a] + 1) * cell_[a] - center_[a];
        const double least = lo > 0 ? lo : hi < 0 ? -hi : 0;
        const double most = std::max(std::abs(lo), std::abs(hi));
        near += least * least;
        far += most * most;
      }
      return near <= reach_ && far >= inner_;
    }

   private:
    double cell_[3], center_[3], reach_, inner_;
  };
};

}  // namespace grelha

namespace grelha::GRELHA_ISA {

// What floats leave open, in u = 2^-24; docs/numerics.md derives it.

/// Times r^2: bound of the error of power = |center - org|^2 - r^2 where the origin is near the
/// surface, 8 u. It is 6 u.
inline constexpr float kPowerError = 0x1p-21f;
/// Times r^2: bound of the error of (half the chord)^2 there, 16 u. It is 11 u.
inline constexpr float kChordError = 0x1p-20f;
/// Floats do for t where |power| is not below this part of r^2: what rounds is 96 u of it there.
inline constexpr float kFarPower = 0x1p-4f;
/// Squares of radii below which what is left of squares may underflow.
inline constexpr float kLeastSquare = 0x1p-100f;

/// Where rays meet spheres.
template <class Real>
struct SphereCrossings {
  Mask<Real> some;    ///< the line crosses
  Real enter, leave;  ///< t; NaN where that is not known after all
};

template <class Real>
[[gnu::always_inline]] inline SphereCrossings<Real> sphere_crossings(const Vec3<Real>& org,
                                                                     const Vec3<Real>& dir,
                                                                     const Real& inv_dd,
                                                                     const Vec3<Real>& center,
                                                                     const Real& radius);

/// What a test is given. A copy: of the hot loop's own variables the address would be taken, and
/// they would leave their registers.
template <class Real>
struct SphereRay {
  Vec3<Real> org, dir, center;
  Real radius;
};

/// sphere_crossings() of float lanes in double, part after part; NaN where the line passes by.
template <class Real, int i = 0>
[[gnu::always_inline]] inline void wide_sphere(const SphereRay<Real>& r,
                                               Wide<Real> (&enter)[kWideParts<Real>],
                                               Wide<Real> (&leave)[kWideParts<Real>]) {
  using Wider = Wide<Real>;
  const Vec3<Wider> dir = widen<i>(r.dir);
  const Wider inv_dd = Wider(1) / dot(dir, dir);
  const SphereCrossings<Wider> met =
      sphere_crossings<Wider>(widen<i>(r.org), dir, inv_dd, widen<i>(r.center), widen<i>(r.radius));
  const Wider nowhere(__builtin_nan(""));
  enter[i] = select(met.some, met.enter, nowhere);
  leave[i] = select(met.some, met.leave, nowhere);
  if constexpr (i + 1 < kWideParts<Real>)
    wide_sphere<Real, i + 1>(r, enter, leave);
}

/// Each t rounded once: only what is rounded tells whether it lies beyond the start of a search.
template <class Real>
[[gnu::noinline]] SphereCrossings<Real> sphere_in_double(const SphereRay<Real>& ray) {
  Wide<Real> enter[kWideParts<Real>], leave[kWideParts<Real>];
  wide_sphere<Real>(ray, enter, leave);
  return {Real(0) == Real(0), narrow<Real>(enter), narrow<Real>(leave)};
}

/// What of rays lies in spheres.
template <class Real>
struct Chord {
  Vec3<Real> to_center;
  Real middle;  ///< t
  Real rr;      ///< radius squared
  Real inside;  ///< half its length, squared; negative of rays that pass beside

  [[gnu::always_inline]] Chord(const Vec3<Real>& org,
                               const Vec3<Real>& dir,
                               const Real& inv_dd,
                               const Vec3<Real>& center,
                               const Real& radius)
      : to_center(center - org), middle(dot(to_center, dir) * inv_dd), rr(radius * radius) {
    const Vec3<Real> gap = middle * dir - to_center;  // center to the line's nearest point
    inside = rr - dot(gap, gap);                      // b*b - a*c would cancel from afar
  }
  /// Below it `inside` is of a ray that passes beside, whatever rounding did.
  static Real least(const Real& rr) {
    return (sizeof(Scalar<Real>) == sizeof(float) ? Real(-kChordError) : Real(0)) * rr;
  }
};

/// Both points of each ray on one sphere, at any t.
///
/// Shapes    rays and spheres pair up lane by lane; either side may be a broadcast.
/// Units     center, radius: scene units; t: multiples of dir. inv_dd is 1 / dot(dir, dir),
///           computed once a ray.
/// Requires  |radius| > 0. A lane with a NaN reports a miss.
/// Accuracy  hit point within 8 eps max(|radius|, |org - center|) of the surface
///           (sphere_test.cpp). Rays that start near the surface, where |center - org|^2 and
///           radius^2 nearly agree, are tested in double.
/// Source    Haines, Günther, Akenine-Möller, "Precision Improvements for Ray/Sphere
///           Intersection", Ray Tracing Gems (2019), ch. 7, in units of t so that one division is
///           left.
template <class Real>
[[gnu::always_inline]] inline SphereCrossings<Real> sphere_crossings(const Vec3<Real>& org,
                                                                     const Vec3<Real>& dir,
                                                                     const Real& inv_dd,
                                                                     const Vec3<Real>& center,
                                                                     const Real& radius) {
  constexpr bool kFloat = sizeof(Scalar<Real>) == sizeof(float);
  const auto [to_center, middle, rr, inside] = Chord<Real>(org, dir, inv_dd, center, radius);
  const Mask<Real> crosses = inside >= Chord<Real>::least(rr);
  if (none(crosses))
    return {crosses, middle, middle};
  const Real half = square_root(inside * inv_dd);  // NaN where inside is negative
  const Real q =
      select(middle < Real(0), middle - half, middle + half);  // like signs add: nothing cancels
  const Real power = dot(to_center, to_center) - rr;
  const Real other = (power * inv_dd) / q;
  SphereCrossings<Real> found{crosses, lesser(other, q), greater(other, q)};
  if constexpr (kFloat) {
    const Mask<Real> tiny = rr < Real(kLeastSquare);
    const Mask<Real> near = both(crosses, either(magnitude(power) < Real(kFarPower) * rr, tiny));
    if (any(near)) {
      // A ray that is surely outside and heads away stays outside, such as one that leaves.
      const Mask<Real> ahead = either(middle > Real(0), power <= Real(kPowerError) * rr);
      const Mask<Real> unsure = both(near, either(ahead, tiny));
      if (any(unsure)) [[unlikely]] {
        const SphereCrossings<Real> exact =
            sphere_in_double<Real>(SphereRay<Real>{org, dir, center, radius});
        found.enter = select(unsure, exact.enter, found.enter);
        found.leave = select(unsure, exact.leave, found.leave);
      }
    }
  }
  return found;
}

/// First point of each ray on one sphere, from outside or inside, whose t is above t_min; of a
/// negative radius from the inside alone.
///
/// Returns   lanes that have one; t is written in all lanes and means nothing in the others.
template <class Real>
[[gnu::always_inline]] inline Mask<Real> hit_sphere(const Vec3<Real>& org,
                                                    const Vec3<Real>& dir,
                                                    const Real& inv_dd,
                                                    const Real& t_min,
                                                    const Vec3<Real>& center,
                                                    const Real& radius,
                                                    Real& t) {
  const SphereCrossings<Real> met = sphere_crossings<Real>(org, dir, inv_dd, center, radius);
  if (none(met.some))
    return met.some;
  t = select(both(met.enter > t_min, radius > Real(0)), met.enter, met.leave);
  return both(met.some, t > t_min);  // NaN fails
}

template <class Real>
[[gnu::always_inline]] inline Mask<Real> meet(const RayLanes<Real>& ray,
                                              const Sphere::Fields<Real>& sphere,
                                              Real& t) {
  return hit_sphere<Real>(
      ray.org, ray.dir, ray.inv_dd, ray.t_min, vec(sphere.center), sphere.radius, t);
}

/// Lanes of spheres that a ray may meet, at any t.
template <class Real>
[[gnu::always_inline]] inline Mask<Real> may_meet(const RayLanes<Real>& ray,
                                                  const Sphere::Fields<Real>& sphere) {
  const Chord<Real> chord(ray.org, ray.dir, ray.inv_dd, vec(sphere.center), sphere.radius);
  return chord.inside >= Chord<Real>::least(chord.rr);
}

/// Lanes of spheres i, i + 1, ... that reach into a frustum.
template <class Frustum>
inline unsigned reaching(const Frustum& f, const FieldArrays<Sphere>& spheres, std::uint32_t i) {
  const Block u = load<Block>(spheres.center[f.u] + i);
  const Block v = load<Block>(spheres.center[f.v] + i);
  const Block k = load<Block>(spheres.center[f.k] + i);
  const Block r = magnitude(load<Block>(spheres.radius + i));
  return f.lanes_inside([&](int j) {
    return ((Block(f.a[j]) * (j < 2 ? u : v) + Block(f.b[j]) * k) + Block(f.c[j])) +
           r * Block(f.reach[j]);
  });
}

/// Groups of rays in a frustum that a sphere may be met by.
template <class Frustum>
inline std::uint64_t groups_near(const Frustum& f, const Sphere::Fields<float>& sphere) {
  const float radius = magnitude(sphere.radius);
  return f.groups_inside([&](int j, int first) {
    const Lanes across = Lanes(f.a[j] * sphere.center[f.side(j)]) +
                         load<Lanes>(f.group_b[j] + first) * Lanes(sphere.center[f.k]);
    return (across + load<Lanes>(f.group_c[j] + first)) +
           Lanes(radius) * load<Lanes>(f.group_reach[j] + first);
  });
}

/// Point and normal where a ray meets a sphere, in double: those of the crossing next to t.
template <class Real>
inline void sphere_crossing(const Vec3<Real>& org,
                            const Vec3<Real>& dir,
                            const Real& t,
                            const Vec3<Real>& center,
                            const Real& radius,
                            Vec3<Real>& point,
                            Vec3<Real>& normal) {
  const Vec3<Real> to_center = center - org;
  const Real inv_dd = Real(1) / dot(dir, dir);
  const Real middle = dot(to_center, dir) * inv_dd;
  const Vec3<Real> gap = middle * dir - to_center;
  const Real inside = greater(radius * radius - dot(gap, gap), Real(0));
  const Real half = square_root(inside * inv_dd);
  normal = normalize(gap + select(t < middle, Real(0) - half, half) * dir);
  point = center + radius * normal;
}

template <class Real, int i = 0>
inline void sphere_places(const Vec3<Real>& org,
                          const Vec3<Real>& dir,
                          const Real& t,
                          const Vec3<Real>& center,
                          const Real& radius,
                          PlaceParts<Real>& to) {
  Vec3<Wide<Real>> point;
  Vec3<Wide<Real>> normal;
  sphere_crossing<Wide<Real>>(
      widen<i>(org), widen<i>(dir), widen<i>(t), widen<i>(center), widen<i>(radius), point, normal);
  int k = 0;
  for (const Vec3<Wide<Real>>* v : {&point, &normal})
    for (const Wide<Real>* x : {&v->x, &v->y, &v->z})
      to.part[k++][i] = *x;
  if constexpr (i + 1 < kWideParts<Real>)
    sphere_places<Real, i + 1>(org, dir, t, center, radius, to);
}

/// Times the radius: a start that far off lets no ray meet the bulge whose cosine with the rounded
/// normal has the wrong sign, 64 u^2. It takes 13 u^2.
inline constexpr float kBulge = 0x1p-42f;

/// Of a ray traced in single, rounded once.
template <class Real>
inline SurfacePlace<Real> rounded_sphere_place(const Vec3<Real>& org,
                                               const Vec3<Real>& dir,
                                               const Real& t,
                                               const Vec3<Real>& c,
                                               const Real& r) {
  PlaceParts<Real> parts;
  sphere_places<Real>(org, dir, t, c, r, parts);
  const Vec3<Real> point = parts.vector(0);
  const Real p = largest(point);
  // The middle term spares most rays that leave the test in double; they would be as right without.
  const Real away = Real(4 * kEps) * p + Real(16 * kEps) * lesser(r, p) + Real(kBulge) * r;
  return {point, parts.vector(3), away};
}

template <class Real>
inline SurfacePlace<Real> sphere_place(const Vec3<Real>& c, const Real& r, const Vec3<Real>& at) {
  const Vec3<Real> n = normalize(at - c);
  const Vec3<Real> point = c + r * n;
  return {
      point,
      n,
      Real(16 * kRounding<Real>) * r + Real(4 * kRounding<Real>) * largest(point),
  };
}

/// Where rays met spheres, of indices i.
template <class Real>
inline Surface<Real> surface_on(const Sphere::Arrays& spheres,
                                const Words<Real>& i,
                                const Meeting<Real>& met) {
  const auto sphere = gathered<Sphere, Real>(spheres.fields, i);
  const Vec3<Real> c = vec(sphere.center);
  const Real r = magnitude(sphere.radius);
  return surface_at<Real>(
      met,
      [&] { return rounded_sphere_place<Real>(met.org, met.dir, met.t, c, r); },
      [&](auto k, const auto& here) { return sphere_place(widen<k>(c), widen<k>(r), here); },
      words_at(spheres.material, i));
}

}  // namespace grelha::GRELHA_ISA
