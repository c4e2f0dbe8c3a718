#pragma once
// All that is known of cones.

#include <cstddef>
#include <vector>

#include "grelha/scene_spans.hpp"
#include "kernel/primitive/arrays.hpp"
#include "kernel/primitive/box.hpp"
#include "kernel/primitive/surface_place.hpp"
#include "kernel/primitive/ray_lanes.hpp"
#include "kernel/simd/vec3.hpp"

namespace grelha {

/// A kind of primitive, as the building of grids sees it; shapes.hpp says what each must have.
struct Cone {
  static constexpr PrimitiveKind kKind = PrimitiveKind::kCone;
  static constexpr bool kFinite = true;
  static constexpr bool kInBlocks = false;

  /// What tests see of the side of a cone frustum, or of many, an array each.
  template <class T>
  struct Fields {
    T base[3];         ///< centre of the narrower end, a cone's tip
    T axis[3];         ///< unit, towards the other end
    T height, radius;  ///< radius: at the narrower end
    T slope;           ///< growth of the radius per unit of height
    T side;            ///< +1: both sides show; -1: only the inside
  };
  template <class Visit, class... F>
  static constexpr void for_each_field(const Visit& visit, F&... of) {
    for_each_axis(visit, of.base...);
    for_each_axis(visit, of.axis...);
    visit(of.height...);
    visit(of.radius...);
    visit(of.slope...);
    visit(of.side...);
  }
  using Arrays = IndexedArrays<Fields<const float*>>;
  using CellList = CellArrays<Fields<const float*>>;

  /// The caller's arrays of numbers.
  template <class Visit>
  static void for_each_array(const ConeSpans& spans, const Visit& visit) {
    for (const Floats* v : {&spans.base_x,
                            &spans.base_y,
                            &spans.base_z,
                            &spans.base_radius,
                            &spans.apex_x,
                            &spans.apex_y,
                            &spans.apex_z,
                            &spans.apex_radius})
      visit(*v);
  }
  static const ConeSpans& spans_of(const GeometrySpans& g) { return g.cones; }
  /// Whether they have one length.
  static bool is_even(const ConeSpans& spans) {
    bool even = true;
    for_each_array(spans, [&](Floats v) { even &= v.size() == spans.size(); });
    return even;
  }
  static std::size_t bytes(const ConeSpans& spans) { return spans.size() * 9 * sizeof(float); }

  /// The caller's cones, with what tests see of them.
  struct Source {
    static constexpr std::size_t kPreparedBytes = sizeof(Fields<float>);  ///< a cone
    ConeSpans spans;
    Fields<std::vector<float>> prepared;
    explicit Source(const GeometrySpans& g);
    std::size_t size() const { return spans.size(); }
    Fields<const float*> fields() const;
    Arrays arrays() const {
      return {
          fields(),
          spans.material.data(),
          static_cast<std::uint32_t>(size()),
      };
    }
    Fields<float> operator[](std::size_t i) const { return one_of<Cone>(prepared, i); }
  };

  /// Of the discs at both ends.
  static Box box(const Source& source, std::size_t i);

  /// Cells of its box are not looked at again.
  struct Touch {
    Touch(const Fields<float>&, const CellFrame&, const CellRange&) {}
    bool operator()(const int (&)[3]) const { return true; }
  };
};

}  // namespace grelha

namespace grelha::GRELHA_ISA {

/// Cones that widen faster are met in double: rounding moves the height of a point by u of what
/// surrounds it, and so its place between the ends by the slope times that (docs/numerics.md).
inline constexpr float kSteep = 8;

/// Lines that surely pass a cone by. aside is off by k = 8 u |to_base| / |dir|, however small the
/// sine between ray and axis: (w + k)^2 <= 9/8 w^2 + 9 k^2.
inline constexpr float kWider = 1.125f;
inline constexpr float kSineRoom = 0x1p-38f;
/// Squares of wider radii below which products of floats may underflow.
inline constexpr float kLeastWidth = 0x1p-100f;

/// The unit vector that a float axis stands for.
template <class Real>
[[gnu::always_inline]] inline Vec3<Real> axis_of(const Cone::Fields<Real>& cone) {
  const Vec3<Real> axis = vec(cone.axis);
  if constexpr (sizeof(Scalar<Real>) == sizeof(float))
    return axis;
  else
    return normalize(axis);
}

/// Where rays meet the sides of cones.
template <class Real>
struct ConeCrossings {
  Mask<Real> some;     ///< the line crosses
  Real first, second;  ///< t, in either order; NaN where it is not of the side
};

/// Takes those float lanes from cone_crossings() in double, each t rounded once.
template <class Real>
[[gnu::noinline, gnu::cold]] void cross_cones_in_double(const Mask<Real>& exactly,
                                                        const Vec3<Real>& org,
                                                        const Vec3<Real>& dir,
                                                        const Cone::Fields<Real>& cone,
                                                        ConeCrossings<Real>& found);

/// The points of each ray on the side of a cone frustum or cylinder, from outside or (through the
/// open ends) inside, at any t.
///
/// Accuracy  hit point within 32 eps (|org - base| + height + wider radius) of the surface; a ray
///           that leaves it from that far above it does not meet it, however flat the cone
///           (cone_test.cpp). The quadratic is solved about the ray's point nearest to the narrower
///           end, where what it is made of is as small as what surrounds the hit. Its discriminant
///           b b - a c is, by Lagrange's identity, also w w - m m: where the roots meet, at a tip,
///           b b is the larger, along the side w w. Less is lost of the smaller. What lies across
///           the axis (pn, n, e, w) is a cross product with it, as long and turned by a quarter: m
///           is p . e then. Steep cones are met in double, and tiny ones, whose products
///           underflow.
/// Source    Haines, NFF document 3.9 (SPD), "c"; stable roots as in Press et al., Numerical
///           Recipes, 5.6.
template <class Real>
[[gnu::always_inline]] inline ConeCrossings<Real> cone_crossings(const Vec3<Real>& org,
                                                                 const Vec3<Real>& dir,
                                                                 const Real& inv_dd,
                                                                 const Cone::Fields<Real>& cone) {
  constexpr bool kFloat = sizeof(Scalar<Real>) == sizeof(float);
  const Real o(0);
  const Vec3<Real> axis = axis_of(cone);
  const Vec3<Real> to_base = vec(cone.base) - org;
  const Vec3<Real> n = cross(dir, axis);  // across the axis, turned by a quarter
  // by dir . dir, or products of four lengths overflow beyond 1e9
  const Vec3<Real> e = inv_dd * n;
  const Real aside = dot(to_base, e), de = dot(n, e);
  const Real wide = cone.radius + cone.slope * cone.height;
  const Real room = Real(kWider) * (wide * wide) * de + Real(kSineRoom) * dot(to_base, to_base);
  const Real within = room * inv_dd - aside * aside;
  // most lines pass the axis further away than the wider radius
  Mask<Real> near_by = within >= o, exactly = o != o;
  if constexpr (kFloat)
    if (exactly = wide * wide < Real(kLeastWidth); any(exactly)) [[unlikely]]
      near_by = either(near_by, exactly);
  if (none(near_by))
    return {near_by, o, o};
  const bool tapers = any(cone.slope > o);
  if (kFloat && tapers)
    exactly = either(exactly, both(near_by, cone.slope > Real(kSteep)));
  const Real near = dot(to_base, dir) * inv_dd;
  const Vec3<Real> p = near * dir - to_base;  // narrower end to the line's nearest point
  const Real pz = dot(p, axis), dz = dot(dir, axis);
  const Vec3<Real> pn = cross(p, axis);
  Real r = cone.radius, a = de, b = dot(pn, e);
  Vec3<Real> w = r * e;
  // of a cylinder the lines below change no bit
  if (tapers) {
    const Real rd = cone.slope * dz, erd = inv_dd * rd;
    r = r + cone.slope * pz;
    a = a - rd * erd;
    b = b - r * erd;
    w = erd * pn - r * e;
  }
  const Real c = inv_dd * (dot(pn, pn) - r * r), bb = b * b, ww = dot(w, w), moment = dot(p, e);
  const Real disc = select(bb < ww, bb - a * c, ww - moment * moment);
  // so that no lane's answer depends on its neighbours, whatever overflows
  const Mask<Real> crosses = both(near_by, either(disc >= o, exactly));
  if (none(crosses))
    return {crosses, o, o};
  const Real root = square_root(disc);
  const Real q = select(b < o, root - b, o - (b + root));
  const auto on_side = [&](const Real& s) __attribute__((always_inline)) {
    const Real h = pz + s * dz;
    const Mask<Real> leaving = (a * s + b) >= o;  // on a tip neither; let no ray out there
    return select(both(both(h >= o, h <= cone.height), either(cone.side > o, leaving)),
                  near + s,
                  Real(__builtin_nanf("")));
  };
  ConeCrossings<Real> found{crosses, on_side(q / a), on_side(c / q)};
  if constexpr (kFloat)
    if (any(exactly)) [[unlikely]]
      cross_cones_in_double(exactly, org, dir, cone, found);
  return found;
}

/// Part after part of the lanes.
template <int i, class Real>
[[gnu::always_inline]] inline void cone_crossing_parts(const Vec3<Real>& org,
                                                       const Vec3<Real>& dir,
                                                       const Cone::Fields<Real>& cone,
                                                       Wide<Real> (&first)[kWideParts<Real>],
                                                       Wide<Real> (&second)[kWideParts<Real>]) {
  using W = Wide<Real>;
  const Vec3<W> d = widen<i>(dir);
  const ConeCrossings<W> met =
      cone_crossings<W>(widen<i>(org), d, W(1) / dot(d, d), widened<Cone, i, Real>(cone));
  const W nowhere(__builtin_nan(""));
  first[i] = select(met.some, met.first, nowhere);
  second[i] = select(met.some, met.second, nowhere);
  if constexpr (i + 1 < kWideParts<Real>)
    cone_crossing_parts<i + 1, Real>(org, dir, cone, first, second);
}

template <class Real>
void cross_cones_in_double(const Mask<Real>& exactly,
                           const Vec3<Real>& org,
                           const Vec3<Real>& dir,
                           const Cone::Fields<Real>& cone,
                           ConeCrossings<Real>& found) {
  Wide<Real> first[kWideParts<Real>], second[kWideParts<Real>];
  cone_crossing_parts<0, Real>(org, dir, cone, first, second);
  found.first = select(exactly, narrow<Real>(first), found.first);
  found.second = select(exactly, narrow<Real>(second), found.second);
}

/// First point of each ray on the side of a cone whose t is above t_min.
///
/// Returns   lanes that have one; t means nothing in the others.
template <class Real>
[[gnu::always_inline]] inline Mask<Real> hit_cone(const Vec3<Real>& org,
                                                  const Vec3<Real>& dir,
                                                  const Real& inv_dd,
                                                  const Real& t_min,
                                                  const Cone::Fields<Real>& cone,
                                                  Real& t) {
  const ConeCrossings<Real> met = cone_crossings<Real>(org, dir, inv_dd, cone);
  if (none(met.some))
    return met.some;
  const Mask<Real> first = met.first > t_min;  // NaN is not
  const Mask<Real> second = met.second > t_min;
  t = select(
      both(first, either(but_not(first, second), met.first < met.second)), met.first, met.second);
  return both(met.some, either(first, second));
}

template <class Real>
[[gnu::always_inline]] inline Mask<Real> meet(const RayLanes<Real>& ray,
                                              const Cone::Fields<Real>& cone,
                                              Real& t) {
  return hit_cone<Real>(ray.org, ray.dir, ray.inv_dd, ray.t_min, cone, t);
}

/// Lanes of cones i, i + 1, ... that may reach into a frustum: a cone lies in the hull of the balls
/// around its two ends.
template <class Frustum>
inline unsigned reaching(const Frustum& f, const FieldArrays<Cone>& cones, std::uint32_t i) {
  const auto at = [i](const float* field) { return load<Block>(field + i); };
  const Block h = at(cones.height);
  const Block r0 = at(cones.radius);
  const Block r1 = r0 + at(cones.slope) * h;
  const Block u0 = at(cones.base[f.u]);
  const Block v0 = at(cones.base[f.v]);
  const Block k0 = at(cones.base[f.k]);
  const Block u1 = u0 + h * at(cones.axis[f.u]);
  const Block v1 = v0 + h * at(cones.axis[f.v]);
  const Block k1 = k0 + h * at(cones.axis[f.k]);
  return f.lanes_inside([&](int j) {
    const Block s(f.a[j]);
    const Block q(f.b[j]);
    const Block reach(f.reach[j]);
    const Block base = (s * (j < 2 ? u0 : v0) + q * k0) + r0 * reach;
    const Block apex = (s * (j < 2 ? u1 : v1) + q * k1) + r1 * reach;
    return greater(base, apex) + Block(f.c[j]);
  });
}

/// Groups of rays in a frustum that a cone may be met by: all, it is not held against each.
template <class Frustum>
inline std::uint64_t groups_near(const Frustum&, const Cone::Fields<float>&) {
  return ~std::uint64_t{0};
}

template <class Real>
inline SurfacePlace<Real> cone_place(const Cone::Fields<Real>& cone, const Vec3<Real>& at) {
  const Vec3<Real> base = vec(cone.base);
  const Vec3<Real> axis = axis_of(cone);
  const Vec3<Real> from_base = at - base;
  const Real above = dot(from_base, axis);
  const Vec3<Real> radial = from_base - above * axis;
  Real along = above;
  // what rounding does to the height of a point, the slope times that would do to its radius
  if (const Mask<Real> steep = cone.slope > Real(kSteep); any(steep)) {
    const Real by_radius = (square_root(dot(radial, radial)) - cone.radius) / cone.slope;
    along = select(steep, by_radius, along);
  }
  const Real h = select(along < Real(0), Real(0), select(along > cone.height, cone.height, along));
  Vec3<Real> u, v;
  across(axis, u, v);
  const Vec3<Real> out = select(
      dot(radial, radial) > Real(0), normalize(radial), u);  // on a tip all directions are as good
  const Vec3<Real> point = base + h * axis + (cone.radius + cone.slope * h) * out;
  const Vec3<Real> n = normalize(out - cone.slope * axis);
  const Real wide = cone.radius + cone.slope * cone.height;
  return {point,
          n,
          Real(32 * kRounding<Real>) * (cone.height + wide) +
              Real(4 * kRounding<Real>) * largest(point)};
}

/// Where rays met cones, of indices i.
template <class Real>
inline Surface<Real> surface_on(const Cone::Arrays& cones,
                                const Words<Real>& i,
                                const Meeting<Real>& met) {
  const auto cone = gathered<Cone, Real>(cones.fields, i);
  return surface_at<Real>(
      met,
      [&] { return cone_place(cone, met.at); },
      [&](auto k, const auto& here) { return cone_place(widened<Cone, k, Real>(cone), here); },
      words_at(cones.material, i));
}

}  // namespace grelha::GRELHA_ISA
