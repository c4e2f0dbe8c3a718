#pragma once
// All that is known of spheres.

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "grelha/scene_spans.hpp"
#include "kernel/shapes/arrays.hpp"
#include "kernel/shapes/box.hpp"
#include "kernel/shapes/surface_position.hpp"
#include "kernel/shapes/hit.hpp"
#include "kernel/base/vec3.hpp"

namespace grelha {

/// A kind of primitive, as the building of grids sees it; shapes.hpp says what each must have.
struct Sphere {
  static constexpr PrimitiveKind kKind = PrimitiveKind::kSphere;
  static constexpr bool kFinite = true;
  static constexpr bool kPositionFromRay = true;  ///< a surface is found without t
  static constexpr bool kInBlocks = false;

  /// A sphere as tests read it; or many, an array per field.
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
  /// True if all arrays have the same length.
  static bool is_even(const SphereSpans& spans) {
    bool even = spans.material.size() == spans.size();
    for_each_array(spans, [&](Floats v) { even &= v.size() == spans.size(); });
    return even;
  }
  static std::size_t bytes(const SphereSpans& spans) { return spans.size() * 5 * sizeof(float); }

  /// The caller's spheres.
  struct Source {
    static constexpr std::size_t kSetupBytes = 0;  ///< a sphere
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
  class Overlap {
   public:
    Overlap(const Fields<float>& s, const CellFrame& g, const CellRange&) {
      const double radius = std::abs(static_cast<double>(s.radius));
      for (int a = 0; a < 3; ++a) {
        cell_[a] = g.cell[a];
        center_[a] = s.center[a] - g.lo[a];
      }
      const double r = radius + g.pad;
      const double inner = radius - g.pad;
      outer_ = r * r;
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
      return near <= outer_ && far >= inner_;
    }

   private:
    double cell_[3], center_[3], outer_, inner_;
  };
};

}  // namespace grelha

namespace grelha::GRELHA_ISA {

// Error bounds of floats or doubles, in u; docs/proofs.md derives each, sphere_test.cpp pins
// them. L: the distances to the centre along the axes together, and the error of coordinates, in u.

/// Chords: with w = kFarError (L + r) and that of a root, (r + w) w bounds the error of the square
/// of half a chord, and w / |dir| that of its middle.
inline constexpr double kFarError = 16;

/// The chords that rays' lines have in spheres.
template <class Real>
struct Chord {
  Vec3<Real> to_center;
  Real middle;  ///< t
  Real rr;      ///< radius squared
  Real inside;  ///< half its length, squared; negative of rays that pass beside

  [[gnu::always_inline]] Chord(const SimdRays<Real>& ray, const Sphere::Fields<Real>& sphere)
      : to_center(ray.to(vec(sphere.center))),
        middle(dot(to_center, ray.dir) * ray.inv_dd),
        rr(sphere.radius * sphere.radius) {
    const Vec3<Real> gap = middle * ray.dir - to_center;  // center to the line's nearest point
    inside = rr - dot(gap, gap);                          // b*b - a*c would cancel from afar
  }
  /// Leaves out lanes that surely have no chord, by a bound for all spheres that are near enough.
  [[gnu::always_inline]] Mask<Real> may_be(const SimdRays<Real>& ray, const Real& radius) const {
    const Real least(static_cast<Scalar<Real>>(-kUnderflow<Real>));
    return inside + ray.error_bound * (magnitude(radius) + ray.error_bound) >= least;
  }
};

/// Tells whether rays surely start outside of spheres or inside, by the power of their origins. For
/// rays that leave a sphere or lie within, it decides more cases than the crossings do.
template <class Real>
struct SphereSide {
  Real w;            ///< see kFarError
  Real error_bound;  ///< what the square of half a chord is off by
  Mask<Real> outside, inside;
  Mask<Real> ahead, behind;  ///< where the middle of the chord surely is

  [[gnu::always_inline]] SphereSide(const SimdRays<Real>& ray,
                                    const Chord<Real>& chord,
                                    const Real& radius) {
    const Real least(static_cast<Scalar<Real>>(kUnderflow<Real>));
    const Vec3<Real> size = sizes(chord.to_center);
    const Real far = (size.x + size.y) + size.z;
    w = units<Real>(kFarError) * (far + radius) + Real(2 * kFarError) * ray.frame_error;
    error_bound = w * (radius + w) + least;
    const Real square = dot(chord.to_center, chord.to_center);
    const Real power = square - chord.rr;
    const Real error = (units<Real>(6) * square + units<Real>(2) * chord.rr) +
                       (Real(8) * ((far + ray.frame_error) * ray.frame_error) + least);
    const Real slack = w * ray.inv_length;
    outside = power > error;
    inside = power < Real(0) - error;
    ahead = chord.middle > slack;
    behind = chord.middle < Real(0) - slack;
  }
};

/// Bounds the crossings of rays and spheres in a precision; a negative radius shows the inside
/// alone.
///
/// Requires  |radius| > 0. A lane with a NaN has no crossing.
/// Source    Haines, Günther, Akenine-Möller, "Precision Improvements for Ray/Sphere
///           Intersection", Ray Tracing Gems (2019), ch. 7, in units of t.
template <class Real>
[[gnu::always_inline]] inline HitInterval<Real> bound(const SimdRays<Real>& ray,
                                                      const Sphere::Fields<Real>& sphere,
                                                      const Real& best) {
  const Real o(0);
  const Chord<Real> chord(ray, sphere);
  const Real& middle = chord.middle;
  Mask<Real> some = chord.may_be(ray, sphere.radius);
  if (none(some))
    return {some, some, middle, middle};
  const SphereSide<Real> side(ray, chord, magnitude(sphere.radius));
  const Mask<Real> past_all = mask_and(mask_and(side.outside, side.behind), ray.t_min >= o);
  some = and_not(some, mask_or(past_all, chord.inside + side.error_bound < o));
  if (none(some))
    return {some, some, middle, middle};
  const Real most = square_root(max(chord.inside + side.error_bound, o) * ray.inv_dd);
  const Real least = square_root(max(chord.inside - side.error_bound, o) * ray.inv_dd);
  const Real slack = side.w * ray.inv_length + units<Real>(4) * most;
  const Real enter_lo = (middle - most) - slack, enter_hi = (middle - least) + slack;
  const Real leave_lo = (middle + least) - slack, leave_hi = (middle + most) + slack;
  const Mask<Real> crosses = chord.inside > side.error_bound;
  const Mask<Real> from_here = ray.t_min == o;
  const Mask<Real> from_inside = mask_and(from_here, side.inside);
  const Mask<Real> from_outside = mask_and(mask_and(from_here, side.ahead), side.outside);
  // the first crossing is surely not the entry
  const Mask<Real> past = mask_or(mask_or(enter_hi <= ray.t_min, from_inside), sphere.radius < o);
  const Mask<Real> enters = and_not(mask_or(enter_lo > ray.t_min, from_outside), past);
  const Mask<Real> leaves = mask_and(past, mask_or(leave_lo > ray.t_min, from_inside));
  const Real lo = select(past, leave_lo, enter_lo);
  some = and_not(some, mask_or(lo > best, leave_hi <= ray.t_min));
  return {some,
          mask_and(mask_and(some, crosses), mask_or(enters, leaves)),
          lo,
          select(past, leave_hi, enter_hi)};
}

/// Spheres that rays cross between t_min and `best`, at any t.
template <class Real>
struct SphereCrossings {
  Mask<Real> some;       ///< not surely none
  Mask<Real> one, both;  ///< surely once, surely twice
};
template <class Real>
[[gnu::always_inline]] inline SphereCrossings<Real> count_crossings(
    const SimdRays<Real>& ray, const Sphere::Fields<Real>& sphere, const Real& best) {
  const Real o(0);
  const Chord<Real> chord(ray, sphere);
  const Mask<Real> some = chord.may_be(ray, sphere.radius);
  if (none(some))
    return {some, some, some};
  const SphereSide<Real> side(ray, chord, magnitude(sphere.radius));
  const Real most = square_root(max(chord.inside + side.error_bound, o) * ray.inv_dd);
  const Real least = square_root(max(chord.inside - side.error_bound, o) * ray.inv_dd);
  const Real slack = side.w * ray.inv_length + units<Real>(4) * most;
  const auto between = [&](const Real& lo, const Real& hi) {
    return mask_and(lo - slack > ray.t_min, hi + slack < best);
  };
  const auto beside = [&](const Real& lo, const Real& hi) {
    return mask_or(hi + slack <= ray.t_min, lo - slack >= best);
  };
  const Real& t = chord.middle;
  const Mask<Real> crosses = mask_and(some, chord.inside > side.error_bound);
  const Mask<Real> shown = sphere.radius > o;
  const Mask<Real> enters = mask_and(between(t - most, t - least), shown);
  const Mask<Real> does_not_enter = mask_or(beside(t - most, t - least), sphere.radius < o);
  const Mask<Real> leaves = between(t + least, t + most);
  const Mask<Real> does_not_leave = beside(t + least, t + most);
  const Mask<Real> one =
      mask_or(mask_and(enters, does_not_leave), mask_and(does_not_enter, leaves));
  const Mask<Real> nothing = mask_and(crosses, mask_and(does_not_enter, does_not_leave));
  return {and_not(some, mask_or(nothing, chord.inside + side.error_bound < o)),
          mask_and(crosses, one),
          mask_and(crosses, mask_and(enters, leaves))};
}

/// Lanes of spheres that a ray does not surely start outside of.
template <class Real>
[[gnu::always_inline]] inline Mask<Real> may_start_inside(const SimdRays<Real>& ray,
                                                          const Sphere::Fields<Real>& sphere) {
  const Chord<Real> chord(ray, sphere);
  const SphereSide<Real> side(ray, chord, magnitude(sphere.radius));
  return and_not(ray.t_min == ray.t_min, side.outside);
}

/// Narrows spans that hold a crossing each; not `sure` where it may not.
///
/// Source    Moore, Interval Analysis (1966): one step of Newton's method from the middle of the
///           span, by the slope's interval over it. No square root; docs/proofs.md has the bound.
template <class Real>
[[gnu::always_inline]] inline HitInterval<Real> narrowed(const SimdRays<Real>& ray,
                                                         const Sphere::Fields<Real>& sphere,
                                                         const Real& lo,
                                                         const Real& hi) {
  const Real t = Real(.5) * (lo + hi);
  const Vec3<Real> to_center = ray.to(vec(sphere.center));
  const Vec3<Real> way = t * ray.dir;
  const Vec3<Real> gap = way - to_center;
  const Vec3<Real> size = sizes(way) + sizes(to_center);
  const Vec3<Real> steep = sizes(ray.dir);
  const Real rr = sphere.radius * sphere.radius;
  const Real error = units<Real>(16) * (dot(sizes(gap), size) + rr) +
                     Real(static_cast<Scalar<Real>>(kUnderflow<Real>));
  const Real inverse = Real(.5) / dot(gap, ray.dir);
  const Real step = (dot(gap, gap) - rr) * inverse;
  // what the slope varies by, relative to itself
  const Real vary = (Real(2) * dot(steep, steep) * (hi - lo) + units<Real>(16) * dot(size, steep)) *
                    magnitude(inverse);
  const Real slack = error * magnitude(inverse) + Real(2) * (magnitude(step) * vary) +
                     units<Real>(8) * (magnitude(step) + magnitude(t));
  const Mask<Real> known = vary < Real(.25);
  return {known, known, (t - step) - slack, (t - step) + slack};
}

inline ExactCrossing exact_crossing(const ExactRay& ray, const Sphere::Fields<float>& sphere) {
  return cross_sphere(ray, sphere.center, sphere.radius);
}

/// Lanes of spheres that a ray may intersect, at any t.
template <class Real>
[[gnu::always_inline]] inline Mask<Real> may_intersect(const SimdRays<Real>& ray,
                                                       const Sphere::Fields<Real>& sphere) {
  return Chord<Real>(ray, sphere).may_be(ray, sphere.radius);
}

/// Lanes of spheres i, i + 1, ... that overlap a frustum.
template <class Frustum>
inline unsigned overlapping(const Frustum& f, const FieldArrays<Sphere>& spheres, std::uint32_t i) {
  const Block u = load<Block>(spheres.center[f.u] + i);
  const Block v = load<Block>(spheres.center[f.v] + i);
  const Block k = load<Block>(spheres.center[f.k] + i);
  const Block r = magnitude(load<Block>(spheres.radius + i));
  return f.inside_mask([&](int j) {
    return ((Block(f.a[j]) * (j < 2 ? u : v) + Block(f.b[j]) * k) + Block(f.c[j])) +
           r * Block(f.gradient_length[j]);
  });
}

/// Groups of rays in a frustum that may hit a sphere.
template <class Frustum>
inline std::uint64_t groups_near(const Frustum& f, const Sphere::Fields<float>& sphere) {
  const float radius = magnitude(sphere.radius);
  return f.groups_inside([&](int j, int first) {
    const VFloat across = VFloat(f.a[j] * sphere.center[f.side(j)]) +
                          load<VFloat>(f.group_b[j] + first) * VFloat(sphere.center[f.k]);
    return (across + load<VFloat>(f.group_c[j] + first)) +
           VFloat(radius) * load<VFloat>(f.group_gradient_length[j] + first);
  });
}

/// Point and normal where a ray hits a sphere, in double: those of the first crossing beyond t =
/// 0, or of the one next to t.
template <class Real>
inline void sphere_crossing(const Vec3<Real>& org,
                            const Vec3<Real>& dir,
                            const Real* t,
                            const Sphere::Fields<Real>& sphere,
                            Vec3<Real>& point,
                            Vec3<Real>& normal) {
  const Real o(0);
  const Vec3<Real> center = vec(sphere.center);
  const Real radius = magnitude(sphere.radius);
  const Vec3<Real> to_center = center - org;
  const Real inv_dd = Real(1) / dot(dir, dir);
  const Real middle = dot(to_center, dir) * inv_dd;
  const Vec3<Real> gap = middle * dir - to_center;
  const Real inside = max(radius * radius - dot(gap, gap), o);
  const Real half = square_root(inside * inv_dd);
  const Mask<Real> enters = t ? *t < middle : mask_and(middle > half, sphere.radius > o);
  normal = normalize(gap + select(enters, o - half, half) * dir);
  point = center + radius * normal;
}

template <class Real, int i = 0>
inline void sphere_positions(const SurfaceHit<Real>& met,
                             const Sphere::Fields<Real>& sphere,
                             PositionParts<Real>& to) {
  Vec3<Wide<Real>> point;
  Vec3<Wide<Real>> normal;
  const Wide<Real> t = to_double<i>(met.t);
  sphere_crossing<Wide<Real>>(to_double<i>(met.org),
                              to_double<i>(met.dir),
                              met.first ? nullptr : &t,
                              fields_to_double<Sphere, i, Real>(sphere),
                              point,
                              normal);
  int k = 0;
  for (const Vec3<Wide<Real>>* v : {&point, &normal})
    for (const Wide<Real>* x : {&v->x, &v->y, &v->z})
      to.part[k++][i] = *x;
  if constexpr (i + 1 < kWideParts<Real>)
    sphere_positions<Real, i + 1>(met, sphere, to);
}

/// A start kBulge * radius off the surface lets no ray hit the bulge whose cosine with the rounded
/// normal has the wrong sign, 64 u^2. It takes 13 u^2.
inline constexpr float kBulge = 0x1p-42f;

/// Surfaces of spheres i at the rays' hits, rounded once.
template <class Real>
inline Surface<Real> surface_on(const Sphere::Arrays& spheres,
                                const Words<Real>& i,
                                const SurfaceHit<Real>& met) {
  const auto sphere = gathered<Sphere, Real>(spheres.fields, i);
  PositionParts<Real> parts;
  sphere_positions<Real>(met, sphere, parts);
  const Vec3<Real> point = parts.vector(0);
  const Real p = largest(point);
  const Real r = magnitude(sphere.radius);
  // The middle term spares most rays that leave the test in double; the result is right without it.
  const Real offset = Real(4 * kEps) * p + Real(16 * kEps) * min(r, p) + Real(kBulge) * r;
  return surface_at<Real>({point, parts.vector(3), offset}, words_at(spheres.material, i));
}

}  // namespace grelha::GRELHA_ISA
