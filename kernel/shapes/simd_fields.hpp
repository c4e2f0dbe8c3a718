#pragma once
// The fields of primitives in lanes.

#include <cstdint>

#include "kernel/shapes/arrays.hpp"
#include "kernel/base/vec3.hpp"

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
