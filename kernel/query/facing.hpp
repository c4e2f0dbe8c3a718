#pragma once
// Triangles that a ray, moved aside by an infinitesimal amount, crosses, and from which side.

#include "kernel/shapes/triangle.hpp"

namespace grelha {

/// crosses_beside(), by doubles where they tell.
inline bool crosses_aside(const ExactRay& ray, const Triangle::Fields<float>& triangle) {
  const scalar::HitInterval<double> bound = scalar::bound_triangle(ray, triangle.corner);
  if (!bound.some || bound.lo >= ray.t_max)
    return false;
  return (bound.sure && bound.hi < ray.t_max) || crosses_beside(ray, triangle.corner);
}

/// Times a sum of the sizes of products: error of a normal times a direction in double, 8 u.
inline constexpr double kFacingError = 16 * 0x1p-53;

/// crosses_front(), by doubles where they tell.
inline bool is_crossed_inwards(const ExactRay& ray, const float (&corner)[3][3]) {
  double sum = 0;
  double size = 0;
  for (int a = 0; a < 3; ++a) {
    const int y = scalar::kNextAxis[a];
    const int z = scalar::kPreviousAxis[a];
    const auto edge = [&](int k, int axis) {
      return double{corner[k][axis]} - double{corner[0][axis]};
    };
    const double first = edge(1, y) * edge(2, z);
    const double second = edge(1, z) * edge(2, y);
    sum += (first - second) * ray.dir[a];
    size += (std::abs(first) + std::abs(second)) * std::abs(ray.dir[a]);
  }
  return std::abs(sum) > kFacingError * size ? sum < 0 : crosses_front(ray, corner);
}

}  // namespace grelha
