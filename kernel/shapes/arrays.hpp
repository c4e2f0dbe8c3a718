#pragma once
// Primitives of one kind in arrays, as plain pointers and in lanes.

#include <cstddef>
#include <cstdint>

#include "kernel/base/vec3.hpp"

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

namespace grelha::GRELHA_ISA {

template <class Shape>
using FieldArrays = typename Shape::template Fields<const float*>;

/// Primitives of indices i, lane by lane.
template <class Shape, class Real>
[[gnu::always_inline]] inline auto gathered(const FieldArrays<Shape>& from, const Words<Real>& i) {
  typename Shape::template Fields<Real> to;
  const auto gather = [&](Real& x, const float* const& of) { x = floats_at(of, i); };
  Shape::for_each_field(gather, to, from);
  return to;
}

/// Primitives from i on, lane by lane.
template <class Shape, class Real>
[[gnu::always_inline]] inline auto side_by_side(const FieldArrays<Shape>& from, std::uint32_t i) {
  typename Shape::template Fields<Real> to;
  const auto take_lanes = [i](Real& x, const float* const& of) { x = take<Real>(of + i); };
  Shape::for_each_field(take_lanes, to, from);
  return to;
}

/// Primitive i in all lanes.
template <class Shape, class Real>
[[gnu::always_inline]] inline auto broadcast(const FieldArrays<Shape>& from, std::uint32_t i) {
  typename Shape::template Fields<Real> to;
  Shape::for_each_field([i](Real& x, const float* const& of) { x = Real(of[i]); }, to, from);
  return to;
}

/// Part k of the lanes, in double.
template <class Shape, int k, class Real>
[[gnu::always_inline]] inline auto fields_to_double(
    const typename Shape::template Fields<Real>& from) {
  typename Shape::template Fields<Wide<Real>> to;
  Shape::for_each_field([](Wide<Real>& x, const Real& of) { x = to_double<k>(of); }, to, from);
  return to;
}

}  // namespace grelha::GRELHA_ISA
