#pragma once
// Checks the guarantees of frustum.hpp ray by ray: follows each ray in long double through the
// slices that the frustum covers, and compares it with the frustum's sides and planes.

#include "kernel/traverse/packet_walk.hpp"
#include "tests/lanes/lane_functions.hpp"

namespace grelha::GRELHA_ISA {

class FrustumChecker {
 public:
  FrustumChecker(const GridView& g, const Rays& rays) : g_(g) {
    p_.size = static_cast<int>(rays.count);
    for (int i = 0; i < p_.size; ++i) {
      for (int a = 0; a < 3; ++a) {
        p_.org[a][i] = rays.org[a][i];
        p_.dir[a][i] = rays.dir[a][i];
      }
      p_.t_min[i] = p_.start[i] = rays.t_min[i];
      p_.best[i] = rays.t_max[i];
    }
    prepare(p_, none_, false);
    out_.together = bound_rays(g, p_, f_) == Coherence::kTogether;
  }

  test::FrustumCheck check() {
    if (!out_.together)
      return out_;
    out_.steepest = f_.steepest;
    check_reaches();
    for (int i = 0; i < p_.size; ++i)
      if (f_.leave[i] > -kInfinity) {
        ++out_.rays;
        check_sides(i);
        check_planes(i);
        check_near(i);
      }
    return out_;
  }

 private:
  using Wide = long double;

  /// Place of a ray in cells along an axis, at t.
  Wide place(int i, int a, Wide t) const {
    const Wide x = static_cast<Wide>(p_.org[a][i]) + t * p_.dir[a][i];
    return (x - static_cast<Wide>(g_.lo[a])) / static_cast<Wide>(g_.cell[a]);
  }
  Wide slice_at(int i, Wide t) const {
    const Wide s = place(i, f_.k, t);
    return f_.flip ? g_.n[f_.k] - s : s;
  }
  Wide t_of_slice(int i, Wide s) const {
    const Wide first = slice_at(i, 0);
    const Wide per = slice_at(i, 1) - first;
    return (s - first) / per;
  }
  bool in_grid(int i, Wide t) const {
    for (int a = 0; a < 3; ++a)
      if (!(place(i, a, t) >= 0) || !(place(i, a, t) <= g_.n[a]))
        return false;
    return true;
  }
  static void keep_greater(double& most, Wide a) {
    // NaN is as wrong as anything
    if (!(static_cast<double>(a) <= most))
      most = static_cast<double>(a);
  }

  void check_sides(int i) {
    const int slices = g_.n[f_.k];
    const int first = clamp_cell(static_cast<double>(f_.from), slices);
    const int last = clamp_cell(static_cast<double>(f_.to), slices);
    const int step = 1 + (last - first) / 16;
    for (int slice = first; slice <= last; slice += step) {
      const SliceSpan span = span_of(f_, slice);
      if (span.end < span.begin)
        continue;  // rays that begin behind the last slice, where nothing lies
      for (const float s : {span.begin, span.end})
        for (int j = 0; j < 2; ++j) {
          const Wide t = t_of_slice(i, static_cast<Wide>(f_.from) + s);
          if (!in_grid(i, t))
            continue;
          const Wide at = place(i, j == 0 ? f_.u : f_.v, t);
          const Interval side = side_in(f_, j, span);
          keep_greater(out_.sides, side.lo - at);
          keep_greater(out_.sides, at - side.hi);
        }
    }
  }

  void check_planes(int i) {
    for (int part = 0; part <= 16; ++part) {
      const Wide s = f_.from + (static_cast<Wide>(f_.to) - f_.from) * part / 16;
      const Wide t = t_of_slice(i, s);
      if (!in_grid(i, t))
        continue;
      float x[3];
      point(i, t, x);
      for (int j = 0; j < 4; ++j) {
        const int side = f_.side(j);
        const float value = (f_.a[j] * x[side] + f_.b[j] * x[f_.k]) + f_.c[j];
        keep_greater(out_.planes, -value);
        keep_greater(out_.balls, passed_by(i, t) * f_.gradient_length[j] - value);
        if (!f_.by_group)
          continue;
        const int group = i / kWidth<VFloat>;
        const float of_group =
            (f_.a[j] * x[side] + f_.group_b[j][group] * x[f_.k]) + f_.group_c[j][group];
        keep_greater(out_.group_planes, -of_group);
      }
    }
  }

  /// What a ball may lie beside a ray that its test in float hits, 24 u of the way.
  Wide passed_by(int i, Wide t) const {
    Wide way = 0;
    for (int a = 0; a < 3; ++a) {
      const Wide d = t * p_.dir[a][i];
      way += d * d;
    }
    return 24 * 0x1p-24L * __builtin_sqrtl(way);
  }

  /// As near as a float comes to a place on a ray: what a primitive there could have for a corner.
  void point(int i, Wide t, float (&x)[3]) const {
    for (int a = 0; a < 3; ++a)
      x[a] = static_cast<float>(static_cast<Wide>(p_.org[a][i]) + t * p_.dir[a][i]);
  }

  /// A hit may lie before its ray's start by what its t is off by, 46 u of the way.
  void check_near(int i) {
    constexpr Wide kOff = 46 * 0x1p-24L;
    const Wide start = p_.start[i];
    const Wide t = start - kOff * (start < 0 ? -start : start);
    if (!in_grid(i, t))
      return;
    float x[3];
    point(i, t, x);
    const float s = f_.to_slice * x[f_.k] + f_.zero_slice;
    keep_greater(out_.near, f_.near - s);
    keep_greater(out_.group_near, f_.group_near[i / kWidth<VFloat>] - s);
  }

  void check_gradient(Wide a, Wide b, float gradient_length) {
    keep_greater(out_.gradient_length, __builtin_sqrtl(a * a + b * b) / gradient_length - 1);
  }
  void check_reaches() {
    for (int j = 0; j < 4; ++j) {
      check_gradient(f_.a[j], f_.b[j], f_.gradient_length[j]);
      for (int group = 0; f_.by_group && group < p_.groups; ++group)
        check_gradient(f_.a[j], f_.group_b[j][group], f_.group_gradient_length[j][group]);
    }
  }

  const GridView& g_;
  Packet p_;
  const GeometryView none_;
  Frustum f_;
  test::FrustumCheck out_;
};

inline test::FrustumCheck check_frustum(const GridView& g, const Rays& rays) {
  return FrustumChecker(g, rays).check();
}

}  // namespace grelha::GRELHA_ISA
