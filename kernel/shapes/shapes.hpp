#pragma once
// The list of all kinds of primitives.
//
// A kind is a struct in a file of its own: what its tests see (Fields, for_each_field), where they
// read it from (Source), how far it reaches (box) and which cells it touches (Touch); beside it, in
// the namespace of an instruction set, how rays meet it.

#include <type_traits>

#include "kernel/shapes/cone.hpp"
#include "kernel/shapes/ids.hpp"
#include "kernel/shapes/plane.hpp"
#include "kernel/shapes/sphere.hpp"
#include "kernel/shapes/triangle.hpp"

namespace grelha {

template <class... Shape>
struct ShapeSet {
  /// Calls visit.operator()<Shape>() for each.
  template <class Visit>
  [[gnu::always_inline]] static constexpr void for_each(const Visit& visit) {
    (visit.template operator()<Shape>(), ...);
  }
};
template <class... A, class... B>
constexpr ShapeSet<A..., B...> operator+(ShapeSet<A...>, ShapeSet<B...>) {
  return {};
}

template <class... Shape>
constexpr auto finite_of(ShapeSet<Shape...>) {
  return (ShapeSet<>{} + ... + std::conditional_t<Shape::kFinite, ShapeSet<Shape>, ShapeSet<>>{});
}

/// All kinds, in the order of their ids. A further kind is a line here.
using Shapes = ShapeSet<Plane, Sphere, Triangle, Cone>;
/// Those that stand in grids.
using FiniteShapes = decltype(finite_of(Shapes{}));

template <class Visit>
[[gnu::always_inline]] constexpr void for_each_shape(const Visit& visit) {
  Shapes::for_each(visit);
}
template <class Visit>
[[gnu::always_inline]] constexpr void for_each_finite_shape(const Visit& visit) {
  FiniteShapes::for_each(visit);
}

/// Calls visit.operator()<Shape>(index) for the kind of an id, one of a set's, and its place among
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

/// One Member<Shape> for each kind of a set, found by of<Shape>().
template <template <class> class Member, class Set>
struct PerShape;
template <template <class> class Member, class... Shape>
struct PerShape<Member, ShapeSet<Shape...>> : Member<Shape>... {
  PerShape() = default;
  /// Each made from the same.
  template <class From>
  explicit PerShape(const From& from) : Member<Shape>(from)... {}
  template <class S>
  [[gnu::always_inline]] constexpr Member<S>& of() {
    return *this;
  }
  template <class S>
  [[gnu::always_inline]] constexpr const Member<S>& of() const {
    return *this;
  }
};

}  // namespace grelha
