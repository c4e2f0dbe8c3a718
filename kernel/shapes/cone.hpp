#pragma once
// All that is known of cones.

#include "kernel/shapes/cone_roots.hpp"

namespace grelha::GRELHA_ISA {

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
