#pragma once
// All that is known of cones.

#include <cstddef>
#include <vector>

#include "grelha/scene_spans.hpp"
#include "kernel/shapes/box.hpp"
#include "kernel/shapes/surface_place.hpp"
#include "kernel/simd/vec3.hpp"

namespace grelha {

/// A kind of primitive, as the building of grids sees it; shapes.hpp says what each must have.
struct Cone {
  static constexpr PrimitiveKind kKind = PrimitiveKind::kCone;
  static constexpr bool kFinite = true;

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
    for (int a = 0; a < 3; ++a)
      visit(of.base[a]...);
    for (int a = 0; a < 3; ++a)
      visit(of.axis[a]...);
    visit(of.height...);
    visit(of.radius...);
    visit(of.slope...);
    visit(of.side...);
  }

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
    Fields<float> operator[](std::size_t i) const {
      Fields<float> c;
      for_each_field([i](float& to, const std::vector<float>& from) { to = from[i]; }, c, prepared);
      return c;
    }
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

/// The side of a cone frustum, prepared: centre of the narrower end (a cone's tip), unit axis
/// towards the other, height, radius at the narrower end, growth of the radius per unit of height,
/// and +1 (both sides show) or -1 (only the inside).
template <class Real>
struct ConeSide {
  Vec3<Real> base, axis;
  Real height, radius, slope, side;
};

/// First point of each ray on the side of a cone frustum or cylinder, from outside or (through the
/// open ends) inside.
///
/// Returns   lanes whose t is above t_min; t means nothing in the others.
/// Accuracy  hit point within 32 eps (|org - base| + height + wider radius) of the surface; a ray
///           that leaves it from that far above it does not meet it (cone_test.cpp). The
///           quadratic is solved about the ray's point nearest to the narrower end, where what it
///           is made of is as small as what surrounds the hit. Its discriminant b b - a c is, by
///           Lagrange's identity, also w w - m m: where the roots meet, at a tip, b b is the
///           larger, along the side w w. Less is lost of the smaller. What lies across the axis
///           (pn, n, e, w) is a cross product with it, as long and turned by a quarter: m is p . e
///           then.
/// Source    Haines, NFF document 3.9 (SPD), "c"; stable roots as in Press et al., Numerical
///           Recipes, 5.6.
template <class Real>
[[gnu::always_inline]] inline Mask<Real> hit_cone(const Vec3<Real>& org,
                                                  const Vec3<Real>& dir,
                                                  const Real& inv_dd,
                                                  const Real& t_min,
                                                  const ConeSide<Real>& cone,
                                                  Real& t) {
  const Real o(0);
  const Vec3<Real> to_base = cone.base - org;
  // what of `dir` runs across the axis, turned by a quarter
  const Vec3<Real> n = cross(dir, cone.axis);
  // by dir . dir, or products of four lengths overflow beyond 1e9
  const Vec3<Real> e = inv_dd * n;
  const Real aside = dot(to_base, e), de = dot(n, e);
  const Real wide = cone.radius + cone.slope * cone.height;
  const Real within = (wide * wide) * inv_dd * de - aside * aside;
  // most lines pass the axis further away than the wider radius
  const Mask<Real> near_by = within >= o;
  if (none(near_by))
    return near_by;
  const Real near = dot(to_base, dir) * inv_dd;
  const Vec3<Real> p = near * dir - to_base;  // narrower end to the line's nearest point
  const Real pz = dot(p, cone.axis), dz = dot(dir, cone.axis);
  const Vec3<Real> pn = cross(p, cone.axis);
  Real r = cone.radius, a = de, b = dot(pn, e);
  Vec3<Real> w = r * e;
  // of a cylinder the lines below change no bit
  if (const Mask<Real> tapers = cone.slope > o; !none(tapers)) {
    const Real rd = cone.slope * dz, erd = inv_dd * rd;
    r = r + cone.slope * pz;
    a = a - rd * erd;
    b = b - r * erd;
    w = erd * pn - r * e;
  }
  const Real c = inv_dd * (dot(pn, pn) - r * r), bb = b * b, ww = dot(w, w), moment = dot(p, e);
  const Real disc = select(bb < ww, bb - a * c, ww - moment * moment);
  // so that no lane's answer depends on its neighbours, whatever overflows
  const Mask<Real> crosses = both(near_by, disc >= o);
  if (none(crosses))
    return crosses;
  const Real root = square_root(disc);
  const Real q = select(b < o, root - b, o - (b + root));
  const Real t1 = q / a, t2 = c / q;
  const auto valid = [&](const Real& s) __attribute__((always_inline)) {
    const Real h = pz + s * dz;
    const Mask<Real> leaving = (a * s + b) >= o;  // on a tip neither; let no ray out there
    return both(both(both(h >= o, h <= cone.height), (near + s) > t_min),
                either(cone.side > o, leaving));
  };
  const Mask<Real> ok1 = valid(t1), ok2 = valid(t2);
  const Mask<Real> first = both(ok1, either(but_not(ok1, ok2), t1 < t2));
  t = near + select(first, t1, t2);
  return both(crosses, either(ok1, ok2));
}

template <class Real>
inline SurfacePlace<Real> cone_place(const Vec3<Real>& base,
                                     const Vec3<Real>& axis,
                                     const Real& height,
                                     const Real& radius,
                                     const Real& slope,
                                     const Vec3<Real>& at) {
  const Vec3<Real> from_base = at - base;
  const Real along = dot(from_base, axis);
  const Real h = select(along < Real(0), Real(0), select(along > height, height, along));
  const Vec3<Real> radial = from_base - h * axis;
  Vec3<Real> u, v;
  across(axis, u, v);
  const Vec3<Real> out = select(
      dot(radial, radial) > Real(0), normalize(radial), u);  // on a tip all directions are as good
  const Vec3<Real> point = base + h * axis + (radius + slope * h) * out,
                   n = normalize(out - slope * axis);
  return {point,
          n,
          Real(32 * kRounding<Real>) * (height + (radius + slope * height)) +
              Real(4 * kRounding<Real>) * largest(point)};
}

/// Where rays met cones, of indices i.
template <class Real>
inline Surface<Real> surface_on(Cone,
                                const GeometryView& g,
                                const Words<Real>& i,
                                const Meeting<Real>& met) {
  const Vec3<Real> base = three_at(g.cone[0], g.cone[1], g.cone[2], i),
                   axis = three_at(g.cone[3], g.cone[4], g.cone[5], i);
  const Real height = floats_at(g.cone[6], i), radius = floats_at(g.cone[7], i),
             slope = floats_at(g.cone[8], i);
  return surface_at<Real>(
      met,
      [&] { return cone_place<Real>(base, axis, height, radius, slope, met.at); },
      [&](auto k, const auto& here) {
        return cone_place(widen<k>(base),
                          widen<k>(axis),
                          widen<k>(height),
                          widen<k>(radius),
                          widen<k>(slope),
                          here);
      },
      words_at(g.cone_material, i));
}

}  // namespace grelha::GRELHA_ISA
