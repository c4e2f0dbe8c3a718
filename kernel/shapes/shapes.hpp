#pragma once
// The list of all kinds of primitives.
//
// A kind is a struct in a file of its own: what its tests see (Fields, for_each_field), where they
// read it from (Source), its bounds (box) and which cells it overlaps (Overlap); beside it, in the
// namespace of an instruction set, how rays intersect it.

#include <cstddef>
#include <type_traits>

#include "kernel/shapes/cone.hpp"
#include "kernel/shapes/plane.hpp"
#include "kernel/shapes/sphere.hpp"
#include "kernel/shapes/triangle_surface.hpp"

namespace grelha {

template <class... Shape>
struct ShapeSet {
  static constexpr std::size_t kCount = sizeof...(Shape);
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

/// The kinds of a set that stand in grids, or the others.
template <bool kFinite, class... Shape>
constexpr auto those_finite(ShapeSet<Shape...>) {
  return (ShapeSet<>{} + ... +
          std::conditional_t<Shape::kFinite == kFinite, ShapeSet<Shape>, ShapeSet<>>{});
}
/// The kinds of a set of finite ones that stand in blocks, or the others.
template <bool kInBlocks, class... Shape>
constexpr auto those_in_blocks(ShapeSet<Shape...>) {
  return (ShapeSet<>{} + ... +
          std::conditional_t<Shape::kInBlocks == kInBlocks, ShapeSet<Shape>, ShapeSet<>>{});
}

/// The kinds whose surface points are computed from t.
template <class... Shape>
constexpr auto shapes_positioned_by_t(ShapeSet<Shape...>) {
  return (ShapeSet<>{} + ... +
          std::conditional_t<requires { Shape::kPositionFromRay; }, ShapeSet<>, ShapeSet<Shape>>{});
}

/// All kinds, in the order of their ids. A further kind is a line here.
using Shapes = ShapeSet<Plane, Sphere, Triangle, Cone>;
/// How many; PrimitiveKind numbers them.
inline constexpr std::size_t kKinds = Shapes::kCount;
/// The number of a kind.
template <class Shape>
inline constexpr auto kNumber = static_cast<std::size_t>(Shape::kKind);

template <class... Shape>
constexpr bool are_numbered(ShapeSet<Shape...>) {
  std::size_t next = 0;
  return ((kNumber<Shape> == next++) && ...);
}
static_assert(are_numbered(Shapes{}), "the list has the order of PrimitiveKind");

/// The kinds that stand in grids, and the kinds that do not.
using FiniteShapes = decltype(those_finite<true>(Shapes{}));
using InfiniteShapes = decltype(those_finite<false>(Shapes{}));
/// The kinds whose lists are arrays of their fields.
using ArrayShapes = decltype(those_in_blocks<false>(FiniteShapes{}));
/// The kinds in a cell in the order of their tests: kinds in blocks come first.
using CellShapes = decltype(those_in_blocks<true>(FiniteShapes{}) + ArrayShapes{});

template <class Visit>
[[gnu::always_inline]] constexpr void for_each_shape(const Visit& visit) {
  Shapes::for_each(visit);
}
template <class Visit>
[[gnu::always_inline]] constexpr void for_each_finite_shape(const Visit& visit) {
  FiniteShapes::for_each(visit);
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
