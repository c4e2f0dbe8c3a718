#include "kernel/shapes/primitives.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <utility>

namespace grelha {

Primitives::Primitives(const GeometrySpans& g) : geometry(g), sources_(g) {
  std::uint32_t next = 0;
  for_each_shape([&]<class Shape>() {
    ids.first[kNumber<Shape>] = next;
    next += static_cast<std::uint32_t>(of<Shape>().size());
  });
  ids.first[kKinds] = next;
}

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

std::vector<Copy> find_duplicates(const Primitives& p, std::span<const std::uint32_t> ids) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> hashed;
  hashed.reserve(ids.size());
  for (const std::uint32_t id : ids)
    hashed.emplace_back(
        p.visit(id,
                [&]<class Shape>(std::uint32_t i) { return hash_of(bits_of(p.of<Shape>()[i])); }),
        id);
  std::sort(hashed.begin(), hashed.end());
  std::vector<Copy> copies;
  for (std::size_t i = 0; i < hashed.size();) {
    const auto [hash, first] = hashed[i];
    for (++i; i < hashed.size() && hashed[i].first == hash; ++i)
      if (is_duplicate(p, hashed[i].second, first))
        copies.push_back({first, hashed[i].second});
  }
  return copies;
}

std::vector<Copy> find_last_copies(const PlaneSpans& spans) {
  GeometrySpans geometry;
  geometry.planes = spans;
  const Plane::Source planes(geometry);
  std::map<decltype(bits_of(planes[0])), std::uint32_t> known;
  std::vector<Copy> last;
  for (std::uint32_t i = 0; i < planes.size(); ++i)
    if (const auto [first, is_new] = known.emplace(bits_of(planes[i]), i); is_new)
      last.clear();
    else
      last.push_back({first->second, i});
  return last;
}

}  // namespace grelha
