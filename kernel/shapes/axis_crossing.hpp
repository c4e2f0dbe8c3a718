#pragma once
// Rays along axes, which meet vertices and edges of regular meshes: doubles hold their edge
// functions exactly where differences of coordinates are as short as floats.

#include "kernel/shapes/triangle.hpp"

namespace grelha {

/// The edges of a triangle as a ray along an axis passes them.
class AxisEdges {
 public:
  AxisEdges(const ExactRay& r, const float (&corner)[3][3]) {
    const int k = scalar::largest_axis(
        static_cast<float>(r.dir[0]), static_cast<float>(r.dir[1]), static_cast<float>(r.dir[2]));
    const int u = scalar::kNextAxis[k];
    const int v = scalar::kPreviousAxis[k];
    is_known_ = r.dir[u] == 0 && r.dir[v] == 0;
    if (!is_known_)
      return;
    double at[3][2];
    for (int i = 0; i < 3; ++i)
      for (const int side : {0, 1}) {
        const int a = side == 0 ? u : v;
        double rest = 0;
        two_sum(corner[i][a], -r.org[a], at[i][side], rest);
        is_known_ &=
            rest == 0 && at[i][side] == static_cast<double>(static_cast<float>(at[i][side]));
      }
    for (int i = 0; i < 3; ++i) {
      const double(&from)[2] = at[(i + 1) % 3];
      const double(&to)[2] = at[(i + 2) % 3];
      const double first = to[0] * from[1];  // products of two floats are exact
      const double second = to[1] * from[0];
      positive_ |= first > second;
      negative_ |= first < second;
      zeros_ |= unsigned{first == second} << i;
    }
  }

  /// True if doubles tell on which side of each edge the ray passes.
  bool is_known() const { return is_known_; }
  bool crosses() const { return positive_ != negative_; }

  /// True if two triangles have the vertex or the edge at which the ray crosses both.
  static bool meet(const AxisEdges& a,
                   const float (&corner)[3][3],
                   const AxisEdges& b,
                   const float (&other)[3][3]) {
    if (!a.is_known_ || !b.is_known_ || a.zeros_ == 0 || b.zeros_ == 0)
      return false;
    // a corner lies on the edges that are not opposite to it
    const auto crossed = [](const AxisEdges& edges, const float(&of)[3][3], const float*(&to)[2]) {
      int count = 0;
      for (int i = 0; i < 3; ++i)
        if ((edges.zeros_ >> i & 1) == 0)
          to[count++] = of[i];
      to[1] = count == 1 ? to[0] : to[1];
      return count > 0;
    };
    const float* one[2];
    const float* two[2];
    if (!crossed(a, corner, one) || !crossed(b, other, two))
      return false;
    const auto is_same = [](const float* p, const float* q) {
      return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
    };
    return (is_same(one[0], two[0]) && is_same(one[1], two[1])) ||
           (is_same(one[0], two[1]) && is_same(one[1], two[0]));
  }

 private:
  bool is_known_ = false, positive_ = false, negative_ = false;
  unsigned zeros_ = 0;  ///< bit i: the ray is on the line of the edge that is opposite to corner i
};

/// bound_triangle() in double; of rays along axes it tells more.
inline scalar::HitInterval<double> bound_crossing(const ExactRay& ray,
                                                  const float (&corner)[3][3]) {
  scalar::HitInterval<double> found = scalar::bound_triangle(ray, corner);
  if (!found.some || found.sure)
    return found;
  const AxisEdges edges(ray, corner);
  if (edges.is_known()) {
    found.some = edges.crosses();
    found.sure = found.some && found.lo > ray.t_min;
  }
  return found;
}

}  // namespace grelha
