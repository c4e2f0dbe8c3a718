#include "kernel/shapes/duplicates.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <set>
#include <utility>

namespace grelha {
namespace {

/// The numbers that a test sees, by their bits.
template <class Fields>
auto bits_of(const Fields& fields) {
  return std::bit_cast<std::array<std::uint32_t, sizeof(Fields) / sizeof(float)>>(fields);
}

/// FNV-1a over words.
std::uint64_t hash_of(std::span<const std::uint32_t> words) {
  std::uint64_t h = 0xCBF29CE484222325u;
  for (const std::uint32_t w : words)
    h = (h ^ w) * 0x100000001B3u;
  return h ^ h >> 32;
}

bool is_duplicate(const Primitives& p, std::uint32_t id, std::uint32_t other) {
  return p.visit(id, [&]<class Shape>(std::uint32_t i) {
    const auto& all = p.of<Shape>();
    return p.ids.has(Shape::kKind, other) &&
           bits_of(all[i]) == bits_of(all[other - p.ids.begin(Shape::kKind)]);
  });
}

}  // namespace

std::vector<std::uint32_t> find_duplicates(const Primitives& p,
                                           std::span<const std::uint32_t> ids) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> hashed;
  hashed.reserve(ids.size());
  for (const std::uint32_t id : ids)
    hashed.emplace_back(
        p.visit(id,
                [&]<class Shape>(std::uint32_t i) { return hash_of(bits_of(p.of<Shape>()[i])); }),
        id);
  std::sort(hashed.begin(), hashed.end());
  std::vector<std::uint32_t> copies;
  for (std::size_t i = 0; i < hashed.size();) {
    const auto [hash, first] = hashed[i];
    for (++i; i < hashed.size() && hashed[i].first == hash; ++i)
      if (is_duplicate(p, hashed[i].second, first))
        copies.push_back(hashed[i].second);
  }
  return copies;
}

std::uint32_t count_unique_planes(const PlaneSpans& spans) {
  GeometrySpans geometry;
  geometry.planes = spans;
  const Plane::Source planes(geometry);
  std::set<decltype(bits_of(planes[0]))> known;
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < planes.size(); ++i)
    if (known.insert(bits_of(planes[i])).second)
      count = i + 1;
  return count;
}

}  // namespace grelha
