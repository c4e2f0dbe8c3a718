#include "grelha/rays.hpp"

#include <stdexcept>
#include <string>

namespace grelha {
namespace {

/// Floats, or words of four bytes, from one element of an array to the next.
template <class Element>
constexpr std::ptrdiff_t words_of() {
  static_assert(sizeof(Element) % sizeof(float) == 0);
  return sizeof(Element) / sizeof(float);
}

void expect_directions(std::size_t origins, std::size_t directions) {
  if (origins != directions)
    throw std::invalid_argument("rays: expected as many directions as origins, found " +
                                std::to_string(directions) + " and " + std::to_string(origins));
}

}  // namespace

Rays Rays::of(std::span<const Ray> rays) {
  static_assert(offsetof(Ray, dir) == 3 * sizeof(float) &&
                offsetof(Ray, t_min) == 6 * sizeof(float));
  static_assert(offsetof(Ray, t_max) == 7 * sizeof(float));
  constexpr std::ptrdiff_t kStride = words_of<Ray>();
  const auto* const p = reinterpret_cast<const float*>(rays.data());
  if (rays.empty())
    return {};
  return {.org = {p, p + 1, p + 2},
          .dir = {p + 3, p + 4, p + 5},
          .t_min = p + 6,
          .t_max = p + 7,
          .count = rays.size(),
          .org_stride = kStride,
          .dir_stride = kStride,
          .t_stride = kStride};
}

Rays Rays::of(std::span<const Float3> org, std::span<const Float3> dir) {
  expect_directions(org.size(), dir.size());
  constexpr std::ptrdiff_t kStride = words_of<Float3>();
  if (org.empty())
    return {};
  const auto* const o = reinterpret_cast<const float*>(org.data());
  const auto* const d = reinterpret_cast<const float*>(dir.data());
  return {.org = {o, o + 1, o + 2},
          .dir = {d, d + 1, d + 2},
          .count = org.size(),
          .org_stride = kStride,
          .dir_stride = kStride};
}

Hits Hits::of(std::span<Hit> hits) {
  static_assert(offsetof(Hit, t) == 0 && offsetof(Hit, id) == sizeof(float));
  if (hits.empty())
    return {};
  auto* const p = reinterpret_cast<char*>(hits.data());
  return {.t = reinterpret_cast<float*>(p),
          .id = reinterpret_cast<std::uint32_t*>(p + offsetof(Hit, id)),
          .stride = words_of<Hit>()};
}

}  // namespace grelha
