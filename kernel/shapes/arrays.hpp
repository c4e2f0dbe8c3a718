#pragma once
// Primitives of one kind in arrays, as plain pointers.

#include <cstddef>
#include <cstdint>

namespace grelha {

inline constexpr int kBlock = 8;  ///< primitives side by side in memory

/// Primitives by index, for work that is done once per hit rather than once per test.
template <class Fields>
struct IndexedArrays {
  Fields fields = {};
  const std::uint32_t* material = nullptr;
  std::uint32_t count = 0;  ///< primitives to test; planes behind these are copies
};

/// Primitives cell after cell: cell i owns elements first[i] up to first[i + 1] - 1. If no cell
/// holds any, first == nullptr. Arrays are padded with kBlock NaN entries, so a whole block can be
/// read from any element.
template <class Fields>
struct CellArrays {
  const std::uint32_t* first = nullptr;
  Fields fields = {};
  const std::uint32_t* id = nullptr;
};

/// Visits x, y and z of one or more.
template <class Visit, class... T>
[[gnu::always_inline]] constexpr void for_each_axis(const Visit& visit, T&... of) {
  visit(of[0]...);
  visit(of[1]...);
  visit(of[2]...);
}

/// One primitive of many, whose fields are arrays.
template <class Shape, class Arrays>
typename Shape::template Fields<float> one_of(const Arrays& fields, std::size_t i) {
  typename Shape::template Fields<float> one;
  Shape::for_each_field([i](float& to, const auto& from) { to = from[i]; }, one, fields);
  return one;
}

}  // namespace grelha
