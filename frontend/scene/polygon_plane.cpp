#include "frontend/scene/polygon_plane.hpp"

#include <algorithm>
#include <cstddef>

namespace grelha {
namespace {

double squared(const Double3& a) {
  return dot(a, a);
}

/// The normal, with twice the area as its length, of the first corner, the one farthest from it,
/// and the one farthest from both.
Double3 normal_of_three(std::span<const Float3> corner_points) {
  Double3 extent{}, normal{};
  for (const Float3& p : corner_points)
    if (const Double3 edge = difference(p, corner_points[0]); squared(edge) > squared(extent))
      extent = edge;
  for (const Float3& p : corner_points)
    if (const Double3 n = cross(extent, difference(p, corner_points[0]));
        squared(n) > squared(normal))
      normal = n;
  return normal;
}

}  // namespace

/// Sums over differences to the first corner: those of nearby floats are exact.
Double3 newell_sum(std::span<const Float3> corner_points) {
  Double3 sum{};
  const Float3 o = corner_points[0];
  Double3 p = difference(corner_points[1], o);
  for (std::size_t i = 2; i < corner_points.size(); ++i) {
    const Double3 q = difference(corner_points[i], o), term = cross(p, q);
    for (std::size_t k = 0; k < 3; ++k)
      sum[k] += term[k];
    p = q;
  }
  return sum;
}

Double3 larger_normal(std::span<const Float3> corner_points, const Double3& sum) {
  Double3 other = normal_of_three(corner_points);
  if (!(squared(other) > squared(sum)))
    return sum;
  const Double3 first = cross(difference(corner_points[1], corner_points[0]),
                              difference(corner_points[2], corner_points[1]));
  const double product = dot(other, sum);
  if (product < 0 || (product == 0 && dot(other, first) < 0))
    other = {-other[0], -other[1], -other[2]};
  return other;
}

/// If parts cancel, the rest may be rounding error, or the side view of a bent outline. Then it is
/// much smaller than the normal of a large triangle, and points elsewhere. For a plane outline both
/// are the same.
Double3 polygon_normal(std::span<const Float3> corner_points) {
  constexpr double kSmaller = 2, kCosine = .9;
  const Double3 sum = newell_sum(corner_points);
  if (corner_points.size() == 3)
    return sum;
  double extent = 0;
  for (const Float3& p : corner_points)
    extent = std::max(extent, squared(difference(p, corner_points[0])));
  if (kSmaller * kSmaller * squared(sum) >= extent * extent)
    return sum;  // no triangle is so much larger
  const Double3 other = larger_normal(corner_points, sum);
  const double product = dot(other, sum), size = squared(other);
  const bool is_lost = size > kSmaller * kSmaller * squared(sum) &&
                       product * product <= kCosine * kCosine * size * squared(sum);
  return is_lost ? other : sum;
}

}  // namespace grelha
