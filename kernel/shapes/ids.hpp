#pragma once
// Which primitive an id is.

#include <cstddef>
#include <cstdint>

#include "kernel/shapes/shapes.hpp"

namespace grelha {

/// The ids of each kind. Kinds follow each other in the order of PrimitiveKind, each in the
/// caller's order; of two hits at equal t the lower id wins.
struct PrimitiveIds {
  std::uint32_t first[kKinds + 1] = {};  ///< of each kind; the last: where all end

  [[gnu::always_inline]] constexpr std::uint32_t begin(PrimitiveKind kind) const {
    return first[static_cast<std::size_t>(kind)];
  }
  [[gnu::always_inline]] constexpr std::uint32_t end(PrimitiveKind kind) const {
    return first[static_cast<std::size_t>(kind) + 1];
  }
  [[gnu::always_inline]] constexpr std::uint32_t count(PrimitiveKind kind) const {
    return end(kind) - begin(kind);
  }
  [[gnu::always_inline]] constexpr std::uint32_t end() const { return first[kKinds]; }
  /// True if an id is of a kind.
  [[gnu::always_inline]] constexpr bool has(PrimitiveKind kind, std::uint32_t id) const {
    return id - begin(kind) < count(kind);
  }
  /// The kind of an id below end().
  [[gnu::always_inline]] constexpr PrimitiveKind kind_of(std::uint32_t id) const {
    std::size_t kind = 0;
    for (std::size_t k = 1; k < kKinds; ++k)
      kind += id >= first[k] ? 1 : 0;
    return static_cast<PrimitiveKind>(kind);
  }
  /// The primitive of an id below end().
  [[gnu::always_inline]] constexpr Primitive primitive(std::uint32_t id) const {
    const PrimitiveKind kind = kind_of(id);
    return {kind, id - begin(kind)};
  }
};

/// Calls visit.operator()<Shape>(index) for the kind of an id, one of a set's, and its index among
/// those of that kind.
template <class First, class... Rest, class Visit>
[[gnu::always_inline]] constexpr auto visit_shape(ShapeSet<First, Rest...>,
                                                  const PrimitiveIds& ids,
                                                  std::uint32_t id,
                                                  const Visit& visit) {
  if constexpr (sizeof...(Rest) > 0)
    if (id >= ids.end(First::kKind))
      return visit_shape(ShapeSet<Rest...>{}, ids, id, visit);
  return visit.template operator()<First>(id - ids.begin(First::kKind));
}

}  // namespace grelha
