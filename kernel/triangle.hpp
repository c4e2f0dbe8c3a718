#pragma once

#include "kernel/vec3.hpp"

namespace grelha::GRELHA_ISA {

/// A ray's own frame for triangle tests: axis `k` is where |dir| is largest (x before y before z on equality), and the
/// shear that lays dir along it. Function of the direction alone, so every triangle sees the same frame.
template <class Real>
struct Shear {
  Real x, y, z;  ///< dir[kx] / dir[kz], dir[ky] / dir[kz], 1 / dir[kz]
};

/// Index of the axis the frame stands on; the other two follow cyclically.
inline int shear_axis(float dx, float dy, float dz) {
  const float ax = magnitude(dx), ay = magnitude(dy), az = magnitude(dz);
  if (ax >= ay && ax >= az) return 0;
  return ay >= az ? 1 : 2;
}

/// a b - c d with the right sign, and its size to within 2^-50 even where the products nearly agree.
inline double difference_of_products(float a, float b, float c, float d) {  // products of floats are exact in double
  return static_cast<double>(a) * b - static_cast<double>(c) * d;
}
inline double difference_of_products(double a, double b, double c, double d) {
  // A product and what rounding took from it: Dekker, "A Floating-Point Technique for Extending the Available Precision", 1971.
  const auto rest = [](double x, double y, double xy) {
    const double p = 134217729. * x, q = 134217729. * y;
    const double x1 = p - (p - x), x2 = x - x1, y1 = q - (q - y), y2 = y - y1;
    return ((x1 * y1 - xy) + x1 * y2 + x2 * y1) + x2 * y2;
  };
  const double ab = a * b, cd = c * d;
  return (ab - cd) + (rest(a, b, ab) - rest(c, d, cd));
}

/// The number itself, or where it is too small for a float the smallest float of its sign.
template <class To>
inline To keep_sign(double e) {
  const To r = static_cast<To>(e);
  if (r == 0 && e != 0) return e < 0 ? To(-1e-45f) : To(1e-45f);
  return r;
}

/// Edge functions again with twice the digits: for those that came out as zero the sign is right then, for those of slivers the
/// size.
template <class Real>
[[gnu::noinline, gnu::cold]] void exact_edges(const Mask<Real>& chosen, const Real (&v)[6], Real& u_out, Real& v_out,
                                              Real& w_out) {
  constexpr int n = kWidth<Real>;
  Scalar<Real> c[6][n], u[n], vv[n], w[n];
  for (int i = 0; i < 6; ++i) store(c[i], v[i]);
  store(u, u_out), store(vv, v_out), store(w, w_out);
  const unsigned lanes = bits(chosen);
  for (int i = 0; i < n; ++i) {
    if (!(lanes >> i & 1)) continue;
    const Scalar<Real> ax = c[0][i], ay = c[1][i], bx = c[2][i], by = c[3][i], cx = c[4][i], cy = c[5][i];
    u[i] = keep_sign<Scalar<Real>>(difference_of_products(cx, by, cy, bx));
    vv[i] = keep_sign<Scalar<Real>>(difference_of_products(ax, cy, ay, cx));
    w[i] = keep_sign<Scalar<Real>>(difference_of_products(bx, ay, by, ax));
  }
  load(u, u_out), load(vv, v_out), load(w, w_out);
}

/// Point where each ray meets one triangle, from either side; watertight along shared edges and at shared vertices.
///
/// Shapes    a, b, c: corners in the ray's permuted axes (kx, ky, kz), lane by lane or broadcast; org likewise.
/// Returns   lanes whose ray crosses the triangle, edges and corners included, with t above t_min.
/// Accuracy  Inside or outside is decided by the exact sign of each edge function of the sheared corners: rounding is
///           monotonic, so a difference of two rounded products has the right sign or is zero, and zeros are taken again
///           in double. Neighbours round a shared edge alike, hence no leaks (tests/watertight_test.cpp). The hit point
///           is within 46 eps of the farthest corner's distance of the triangle (tests/triangle_test.cpp).
/// Source    Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013.
template <class Real>
[[gnu::always_inline]] inline Mask<Real> hit_triangle(const Vec3<Real>& org, const Shear<Real>& shear, const Real& t_min, const Vec3<Real>& a,
                               const Vec3<Real>& b, const Vec3<Real>& c, Real& t, Vec3<Real>* weights = nullptr) {
  const Vec3<Real> oa = a - org, ob = b - org, oc = c - org;
  const Real ax = oa.x - shear.x * oa.z, ay = oa.y - shear.y * oa.z;
  const Real bx = ob.x - shear.x * ob.z, by = ob.y - shear.y * ob.z;
  const Real cx = oc.x - shear.x * oc.z, cy = oc.y - shear.y * oc.z;
  Real u = cx * by - cy * bx;
  Real v = ax * cy - ay * cx;
  Real w = bx * ay - by * ax;
  const Real o(0);
  const Mask<Real> zero = either(either(u == o, v == o), w == o);
  if (any(zero)) exact_edges<Real>(zero, {ax, ay, bx, by, cx, cy}, u, v, w);
  const Mask<Real> below = either(either(u < o, v < o), w < o);
  const Mask<Real> above = either(either(u > o, v > o), w > o);
  Real det = (u + v) + w;
  const Mask<Real> crosses = but_not(det != o, both(below, above));
  if (none(crosses)) return crosses;
  const Real ta = shear.z * oa.z, tb = shear.z * ob.z, tc = shear.z * oc.z;
  // Seen edge on, or thin, a triangle has edge functions far smaller than the products they are differences of, and the mean
  // of the depths below would be off by that ratio times what lies between these. Where this exceeds 4 times the greatest: double.
  const Real size = greater(greater(greater(magnitude(ax), magnitude(ay)), greater(magnitude(bx), magnitude(by))),
                            greater(magnitude(cx), magnitude(cy)));
  const Real most = greater(greater(ta, tb), tc), least = lesser(lesser(ta, tb), tc);
  const Real far = greater(magnitude(most), magnitude(least));
  Mask<Real> thin = both(crosses, (size * size) * (most - least) > (Real(4) * far) * magnitude(det));
  if (weights) {  // across the ray as well
    const Real reach = greater(greater(magnitude(oa.z), magnitude(ob.z)), magnitude(oc.z));
    thin = either(thin, both(crosses, (size * size) * size > (Real(4) * reach) * magnitude(det)));
  }
  if (any(thin)) {
    exact_edges<Real>(thin, {ax, ay, bx, by, cx, cy}, u, v, w);
    det = (u + v) + w;
  }
  t = ((u * ta + v * tb) + w * tc) / det;
  if (weights) *weights = {u / det, v / det, w / det};
  return both(crosses, t > t_min);  // a NaN anywhere fails here
}

}  // namespace grelha::GRELHA_ISA
