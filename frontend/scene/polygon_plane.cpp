#include "frontend/scene/polygon_plane.hpp"

#include <algorithm>
#include <cstddef>

namespace grelha {
namespace {

double squared(const Double3& a) {
  return dot(a, a);
}

/// Sums over differences to the first corner. Differences of nearby floats are exact, so corners on
/// one line give zero.
Double3 newell_sum(std::span<const Float3> corners) {
  Double3 sum{};
  const Float3 o = corners[0];
  Double3 p = difference(corners[1], o);
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const Double3 q = difference(corners[i], o), term = cross(p, q);
    for (std::size_t k = 0; k < 3; ++k)
      sum[k] += term[k];
    p = q;
  }
  return sum;
}

/// The normal, with twice the area as its length, of the first corner, the one farthest from it,
/// and the one farthest from both.
Double3 normal_of_three(std::span<const Float3> corners) {
  Double3 reach{}, normal{};
  for (const Float3& p : corners)
    if (const Double3 edge = difference(p, corners[0]); squared(edge) > squared(reach))
      reach = edge;
  for (const Float3& p : corners)
    if (const Double3 n = cross(reach, difference(p, corners[0])); squared(n) > squared(normal))
      normal = n;
  return normal;
}

}  // namespace

Double3 larger_normal(std::span<const Float3> corners, const Double3& sum) {
  Double3 other = normal_of_three(corners);
  if (!(squared(other) > squared(sum)))
    return sum;
  const Double3 first =
      cross(difference(corners[1], corners[0]), difference(corners[2], corners[1]));
  const double along = dot(other, sum);
  if (along < 0 || (along == 0 && dot(other, first) < 0))
    other = {-other[0], -other[1], -other[2]};
  return other;
}

/// If parts cancel, the rest may be rounding error, or the side view of a bent outline. Then it is
/// much smaller than the normal of a large triangle, and points elsewhere. For a plane outline both
/// are the same.
Double3 polygon_normal(std::span<const Float3> corners) {
  constexpr double kSmaller = 2, kCosine = .9;
  const Double3 sum = newell_sum(corners);
  if (corners.size() == 3)
    return sum;
  double reach = 0;
  for (const Float3& p : corners)
    reach = std::max(reach, squared(difference(p, corners[0])));
  if (kSmaller * kSmaller * squared(sum) >= reach * reach)
    return sum;  // no triangle is so much larger
  const Double3 other = larger_normal(corners, sum);
  const double along = dot(other, sum), size = squared(other);
  const bool is_lost = size > kSmaller * kSmaller * squared(sum) &&
                       along * along <= kCosine * kCosine * size * squared(sum);
  return is_lost ? other : sum;
}

}  // namespace grelha
