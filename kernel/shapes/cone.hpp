#pragma once
// All that is known of cones.

#include <cstddef>
#include <type_traits>
#include <vector>

#include "grelha/scene_spans.hpp"
#include "kernel/shapes/arrays.hpp"
#include "kernel/shapes/box.hpp"
#include "kernel/shapes/surface_position.hpp"
#include "kernel/shapes/hit.hpp"
#include "kernel/base/vec3.hpp"

namespace grelha {

/// A kind of primitive, as the building of grids sees it; shapes.hpp says what each must have.
struct Cone {
  static constexpr PrimitiveKind kKind = PrimitiveKind::kCone;
  static constexpr bool kFinite = true;
  static constexpr bool kInBlocks = false;

  /// The side of a cone frustum as tests read it; or the sides of many, an array per field.
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
  /// True if all arrays have the same length.
  static bool is_even(const ConeSpans& spans) {
    bool even = spans.material.size() == spans.size();
    for_each_array(spans, [&](Floats v) { even &= v.size() == spans.size(); });
    return even;
  }
  static std::size_t bytes(const ConeSpans& spans) { return spans.size() * 9 * sizeof(float); }

  /// The caller's cones, and the fields that tests read, prepared from these.
  struct Source {
    static constexpr std::size_t kSetupBytes = sizeof(Fields<float>);  ///< a cone
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

  /// Box around the discs at both ends.
  static Box box(const Source& source, std::size_t i);

  /// Cells of its box are not looked at again.
  struct Overlap {
    Overlap(const Fields<float>&, const CellFrame&, const CellRange&) {}
    bool operator()(const int (&)[3]) const { return true; }
  };
};

}  // namespace grelha

// Crossings of rays and the sides of cones, in float and in double.

namespace grelha::GRELHA_ISA {

// Bounds of floats for lines that surely pass a cone by; docs/proofs.md derives them.

/// Squared radius of the cylinder around a cone = kWider * square of the wider radius.
inline constexpr float kWider = 1.125f;
/// error <= kPassError * square of the sum of a cone's distance, its size, and the error of
/// coordinates in u.
inline constexpr float kPassError = 0x1p-36f;
/// The same of heights, by the sum itself.
inline constexpr float kPassHeight = 0x1p-18f;
/// Lines nearer to the axis' direction are in a cylinder for longer than floats can tell.
inline constexpr float kLeastSine = 0x1p-30f;
/// Squares of wider radii below which products of floats may underflow.
inline constexpr float kLeastWidth = 0x1p-100f;

template <class Real>
[[gnu::always_inline]] inline Real sum_of_sizes(const Vec3<Real>& a) {
  return (magnitude(a.x) + magnitude(a.y)) + magnitude(a.z);
}

/// A line beside the cylinder around a cone.
template <class Real>
struct ConePass {
  Mask<Real> may_cross;  ///< not surely outside of the cylinder: most lines are
  Mask<Real> is_steep;   ///< the next two tell where the line surely is outside
  Real enter, leave;

  [[gnu::always_inline]] ConePass(const SimdRays<Real>& ray, const Cone::Fields<Real>& cone) {
    const Vec3<Real> axis = vec(cone.axis);
    const Vec3<Real> to_base = ray.to(vec(cone.base));
    const Real wide = cone.radius + cone.slope * cone.height;
    const Real size =
        (sum_of_sizes(to_base) + (cone.height + wide)) + Real(0x1p23f) * ray.frame_error;
    const Vec3<Real> n = cross(ray.dir, axis);  // across the axis, turned by a quarter
    // by dir . dir, or products of four lengths overflow beyond 1e9
    const Vec3<Real> e = ray.inv_dd * n;
    const Real sine = dot(n, e);  // squared
    const Real aside = dot(to_base, e);
    const Real slack = Real(kPassError) * (size * size);
    const Real chord = (Real(kWider) * (wide * wide) * sine + slack) * ray.inv_dd - aside * aside;
    const Real inverse = Real(1) / sine;
    const Real middle = dot(cross(to_base, axis), e) * inverse;
    const Real half = square_root(chord) * inverse;
    enter = middle - half;
    leave = middle + half;
    const Mask<Real> tiny = wide * wide < Real(kLeastWidth);
    is_steep = and_not(sine > Real(kLeastSine), tiny);
    const Real along = dot(ray.dir, axis);
    const Real height = middle * along - dot(to_base, axis);
    const Real range = half * magnitude(along) + Real(kPassHeight) * size;
    const Mask<Real> past = mask_or(height - range > cone.height, height + range < Real(0));
    may_cross = mask_or(and_not(chord >= Real(0), mask_and(is_steep, past)), tiny);
  }
};

/// Lanes whose line does not surely pass a cone by.
template <class Real>
[[gnu::always_inline]] inline Mask<Real> may_intersect(const SimdRays<Real>& ray,
                                                       const Cone::Fields<Real>& cone) {
  return ConePass<Real>(ray, cone).may_cross;
}

// Error bounds of floats or doubles, in u; docs/proofs.md derives each, cone_test.cpp pins them.
// T: the distance from the ray's origin to the cone and its size together, with the error of
// coordinates, in u: points beside the cone are off by 8 u T. G: (1 + slope)^2.

/// Discriminant: error <= kDiscError * T R G^2 / dir^2, R being how far from the narrower end the
/// line passes and the radius there together.
inline constexpr double kDiscError = 128;
/// Square of a point's distance to the axis less that of the side there: error <= kSideError * T R
/// G, R being both distances together.
inline constexpr double kSideError = 64;
/// The same of where a ray starts, T being its distance and the radius.
inline constexpr double kStartError = 12;
/// Heights around a root, besides kRootError: error <= kHeightError * T.
inline constexpr double kHeightError = 32;
/// The side is looked for within kRootError * T / |dir| of a root. Doubles afford more.
template <class Real>
inline constexpr double kRootError = std::is_same_v<Scalar<Real>, float> ? 0x1p-14 : 0x1p-37;

/// The unit vector that a float axis stands for.
template <class Real>
[[gnu::always_inline]] inline Vec3<Real> axis_of(const Cone::Fields<Real>& cone) {
  const Vec3<Real> axis = vec(cone.axis);
  if constexpr (sizeof(Scalar<Real>) == sizeof(float))
    return axis;
  else
    return normalize(axis);
}

/// A line beside the side of a cone: frustum or cylinder, from outside or (through the open ends)
/// inside.
template <class Real>
struct ConeLine {
  Vec3<Real> axis, p;  ///< unit; from the narrower end to the line's nearest point, at s = 0
  Real near;           ///< t there
  Real a, b, c;        ///< a s^2 + 2 b s + c = 0 on the side and its like beyond the tip
  Real disc;           ///< b b - a c
  Real error;          ///< of it
  Real size;           ///< T
  Real slopes;         ///< G
  Mask<Real> outside, inside;  ///< where the ray surely starts, beside the side

  /// The quadratic is solved about the ray's point nearest to the narrower end, where its
  /// coefficients are as small as the surroundings of the hit. Its discriminant is, by Lagrange's
  /// identity, also w w - m m: where the roots meet, at a tip, b b is the larger, along the side w
  /// w. The smaller of the two loses less.
  [[gnu::always_inline]] ConeLine(const SimdRays<Real>& ray, const Cone::Fields<Real>& cone)
      : axis(axis_of(cone)) {
    const Vec3<Real> to_base = ray.to(vec(cone.base));
    const Vec3<Real> n = cross(ray.dir, axis);
    const Vec3<Real> e = ray.inv_dd * n;
    near = dot(to_base, ray.dir) * ray.inv_dd;
    p = near * ray.dir - to_base;
    const Vec3<Real> pn = cross(p, axis);
    const Real r = cone.radius + cone.slope * dot(p, axis);
    const Real rd = cone.slope * dot(ray.dir, axis);
    const Real erd = ray.inv_dd * rd;
    a = dot(n, e) - rd * erd;
    b = dot(pn, e) - r * erd;
    c = ray.inv_dd * (dot(pn, pn) - r * r);
    const Vec3<Real> w = erd * pn - r * e;
    const Real moment = dot(p, e);
    const Real bb = b * b;
    const Real ww = dot(w, w);
    disc = select(bb < ww, bb - a * c, ww - moment * moment);
    size = sum_of_sizes(to_base) + ((cone.height + cone.radius) + cone.slope * cone.height) +
           Real(static_cast<Scalar<Real>>(.5 / kUnit<Real>)) * ray.frame_error;
    const Real slope = Real(1) + cone.slope;
    slopes = slope * slope;
    const Real distance_error = units<Real>(kDiscError) * (slopes * slopes) * size;
    error = (distance_error * ((sum_of_sizes(p) + magnitude(r)) + distance_error)) * ray.inv_dd;
    const Vec3<Real> across = cross(to_base, axis);
    const Real side = cone.radius - cone.slope * dot(to_base, axis);
    const Real above = dot(across, across) - side * side;
    const Real start_off =
        units<Real>(kStartError) * slopes * (sum_of_sizes(to_base) + cone.radius) +
        Real(8) * (slopes * ray.frame_error);
    const Real start_error = start_off * ((sum_of_sizes(across) + magnitude(side)) + start_off);
    outside = above > start_error;
    inside = above < Real(0) - start_error;
  }
};

/// A root of a line and a cone's side.
template <class Real>
struct ConeRoot {
  Mask<Real> some, sure;  ///< not surely none; surely one
  Real lo, hi;            ///< t

  /// The root is near t = line.near + s where the side is crossed within kRootError of it.
  [[gnu::always_inline]] ConeRoot(const SimdRays<Real>& ray,
                                  const Cone::Fields<Real>& cone,
                                  const ConeLine<Real>& line,
                                  const Real& s) {
    const Real o(0);
    const Real part(static_cast<Scalar<Real>>(kRootError<Real>));
    const Real beside = (part * line.size) * ray.inv_length;
    const Vec3<Real> at = line.p + s * ray.dir;
    const Vec3<Real> by = beside * ray.dir;
    const auto above_side = [&](const Vec3<Real>& v) {
      const Vec3<Real> across = cross(v, line.axis);
      const Real side = cone.radius + cone.slope * dot(v, line.axis);
      return dot(across, across) - side * side;
    };
    const Real before = above_side(at - by);
    const Real after = above_side(at + by);
    const Real far = sum_of_sizes(at);
    const Real h = dot(at, line.axis);
    const Real beyond_axis = sum_of_sizes(cross(at, line.axis)) +
                             (magnitude(cone.radius + cone.slope * h) + part * line.size);
    const Real distance_error = (units<Real>(kSideError) * line.slopes) * (line.size + far);
    const Real error = distance_error * (beyond_axis + distance_error);
    const Mask<Real> enters = mask_and(before > error, after < o - error);
    const Mask<Real> leaves = mask_and(before<o - error, after> error);
    const Mask<Real> known = mask_or(enters, leaves);
    const Real height_error =
        Real(static_cast<Scalar<Real>>(2 * kRootError<Real> + kHeightError * kUnit<Real>)) *
        (line.size + far);
    lo = (line.near + s) - beside;
    hi = (line.near + s) + beside;
    const Real slack = units<Real>(4) * (magnitude(line.near) + magnitude(s));
    lo = lo - slack;
    hi = hi + slack;
    const Mask<Real> beyond = mask_or(h<o - height_error, h> cone.height + height_error);
    const Mask<Real> shows = mask_or(cone.side > o, leaves);
    // a ray that starts at t = 0 outside is there before it enters, and after it has left
    const Mask<Real> from_here =
        mask_and(mask_and(ray.t_min == o, known), mask_and(lo <= o, hi > o));
    const Mask<Real> ahead =
        mask_and(from_here, mask_or(mask_and(enters, line.outside), mask_and(leaves, line.inside)));
    const Mask<Real> behind =
        mask_and(from_here, mask_or(mask_and(leaves, line.outside), mask_and(enters, line.inside)));
    const Mask<Real> counts = mask_and(and_not(hi > ray.t_min, behind), and_not(shows, beyond));
    some = mask_or(counts, and_not(o == o, known));
    const Mask<Real> between = mask_and(h > height_error, h < cone.height - height_error);
    sure = mask_and(mask_and(known, between), mask_and(mask_or(lo > ray.t_min, ahead), shows));
  }
};

/// Bounds the crossings of selected rays and cones in a precision.
template <class Real>
[[gnu::always_inline]] inline HitInterval<Real> bound_roots(const SimdRays<Real>& ray,
                                                            const Cone::Fields<Real>& cone,
                                                            const Mask<Real>& selected) {
  const Real o(0);
  const ConeLine<Real> line(ray, cone);
  const Mask<Real> may_cross = and_not(selected, line.disc < o - line.error);
  if (none(may_cross))
    return {may_cross, may_cross, line.near, line.near};
  const Real root = square_root(max(line.disc, o));
  const Real q = select(line.b < o, root - line.b, o - (line.b + root));
  const Real one = q / line.a;
  const Real other = line.c / q;
  const ConeRoot<Real> first(ray, cone, line, min(one, other));
  const Mask<Real> sure = mask_and(may_cross, line.disc > line.error);
  if (none(and_not(may_cross, first.sure)))
    return {may_cross, sure, first.lo, first.hi};
  const ConeRoot<Real> second(ray, cone, line, max(one, other));
  return {mask_and(may_cross, mask_or(first.some, second.some)),
          mask_and(sure, mask_or(first.sure, and_not(second.sure, first.some))),
          select(first.some, first.lo, second.lo),
          select(first.some, first.hi, second.hi)};
}

/// Part after part of the lanes, in double: 1 where there may be a crossing, 2 where there is.
template <int i, class Real>
[[gnu::always_inline]] inline void bound_parts(const SimdRays<Real>& ray,
                                               const Cone::Fields<Real>& cone,
                                               Wide<Real> (&told)[kWideParts<Real>],
                                               Wide<Real> (&lo)[kWideParts<Real>],
                                               Wide<Real> (&hi)[kWideParts<Real>]) {
  using W = Wide<Real>;
  const HitInterval<W> f =
      bound_roots<W>(given_in_double<i>(ray), fields_to_double<Cone, i, Real>(cone), W(0) == W(0));
  told[i] = select(f.some, select(f.sure, W(2), W(1)), W(0));
  lo[i] = rounded_down(f.lo - shift_in_double<i>(ray));
  hi[i] = rounded_up(f.hi - shift_in_double<i>(ray));
  if constexpr (i + 1 < kWideParts<Real>)
    bound_parts<i + 1, Real>(ray, cone, told, lo, hi);
}

/// Takes selected lanes from double.
template <class Real>
[[gnu::noinline]] void bound_in_double(const SimdRays<Real>& ray,
                                       const Cone::Fields<Real>& cone,
                                       const Mask<Real>& selected,
                                       HitInterval<Real>& found) {
  Wide<Real> told[kWideParts<Real>], lo[kWideParts<Real>], hi[kWideParts<Real>];
  bound_parts<0, Real>(ray, cone, told, lo, hi);
  const Real known = narrow<Real>(told);
  found.some = and_not(found.some, mask_and(selected, known == Real(0)));
  found.sure = mask_and(found.some, mask_or(found.sure, mask_and(selected, known > Real(1))));
  found.lo = select(selected, narrow<Real>(lo), found.lo);
  found.hi = select(selected, narrow<Real>(hi), found.hi);
}

/// Bounds the crossings of rays and cones in a precision; doubles decide what floats cannot.
template <class Real>
[[gnu::always_inline]] inline HitInterval<Real> bound(const SimdRays<Real>& ray,
                                                      const Cone::Fields<Real>& cone,
                                                      const Real& best) {
  if constexpr (sizeof(Scalar<Real>) == sizeof(double)) {
    return bound_roots<Real>(ray, cone, best == best);
  } else {
    const ConePass<Real> pass(ray, cone);
    const Mask<Real> past = mask_or(pass.enter > best, pass.leave < ray.t_min);
    const Mask<Real> may_cross = and_not(pass.may_cross, mask_and(pass.is_steep, past));
    if (none(may_cross))
      return {may_cross, may_cross, best, best};
    HitInterval<Real> found = bound_roots<Real>(ray, cone, may_cross);
    const Real wide = cone.radius + cone.slope * cone.height;
    const Mask<Real> tiny = wide * wide < Real(kLeastWidth);
    const Mask<Real> before = and_not(found.some, mask_and(found.sure, found.lo > best));
    found.some = mask_and(may_cross, mask_or(before, tiny));
    found.sure = and_not(found.sure, tiny);
    const Mask<Real> unsure = and_not(found.some, found.sure);
    if (any(unsure))
      bound_in_double(ray, cone, unsure, found);
    return found;
  }
}

// All that is known of cones.

inline ExactCrossing exact_crossing(const ExactRay& ray, const Cone::Fields<float>& c) {
  return cross_cone(ray,
                    {{c.base[0], c.base[1], c.base[2]},
                     {c.axis[0], c.axis[1], c.axis[2]},
                     c.height,
                     c.radius,
                     c.slope,
                     c.side});
}

/// Lanes of cones i, i + 1, ... that may overlap a frustum: a cone lies in the hull of the balls
/// around its two ends.
template <class Frustum>
inline unsigned overlapping(const Frustum& f, const FieldArrays<Cone>& cones, std::uint32_t i) {
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
  return f.inside_mask([&](int j) {
    const Block s(f.a[j]);
    const Block q(f.b[j]);
    const Block gradient_length(f.gradient_length[j]);
    const Block base = (s * (j < 2 ? u0 : v0) + q * k0) + r0 * gradient_length;
    const Block apex = (s * (j < 2 ? u1 : v1) + q * k1) + r1 * gradient_length;
    return max(base, apex) + Block(f.c[j]);
  });
}

/// Groups of rays in a frustum that may hit a cone.
template <class Frustum>
inline std::uint64_t groups_near(const Frustum& f, const Cone::Fields<float>& cone) {
  const float apex_radius = cone.radius + cone.slope * cone.height;
  const float apex_along = cone.base[f.k] + cone.height * cone.axis[f.k];
  return f.groups_inside([&](int j, int first) {
    const int side = f.side(j);
    const float apex_across = cone.base[side] + cone.height * cone.axis[side];
    const VFloat slope = load<VFloat>(f.group_b[j] + first);
    const VFloat gradient_length = load<VFloat>(f.group_gradient_length[j] + first);
    const VFloat base = (VFloat(f.a[j] * cone.base[side]) + slope * VFloat(cone.base[f.k])) +
                        gradient_length * VFloat(cone.radius);
    const VFloat apex = (VFloat(f.a[j] * apex_across) + slope * VFloat(apex_along)) +
                        gradient_length * VFloat(apex_radius);
    return max(base, apex) + load<VFloat>(f.group_c[j] + first);
  });
}

/// Steeper slopes: points are positioned by their radius.
inline constexpr float kSteep = 8;

template <class Real>
inline SurfacePosition<Real> cone_position(const Cone::Fields<Real>& cone, const Vec3<Real>& at) {
  const Vec3<Real> base = vec(cone.base);
  const Vec3<Real> axis = vec(cone.axis);
  const Vec3<Real> from_base = at - base;
  const Real above = dot(from_base, axis);
  const Vec3<Real> radial = from_base - above * axis;
  Real along = above;
  // a rounding error of a point's height would move its radius by the slope times as much
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
  return {point, n, Real(32 * kEps) * (cone.height + wide) + Real(4 * kEps) * largest(point)};
}

/// Surfaces of cones i at the rays' hits.
template <class Real>
inline Surface<Real> surface_on(const Cone::Arrays& cones,
                                const Words<Real>& i,
                                const SurfaceHit<Real>& met) {
  const auto cone = gathered<Cone, Real>(cones.fields, i);
  return surface_at<Real>(cone_position(cone, met.at), words_at(cones.material, i));
}

}  // namespace grelha::GRELHA_ISA
