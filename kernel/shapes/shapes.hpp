#pragma once
// The list of all kinds of primitives.
//
// A kind is a struct in a file of its own: what its tests see (Fields, for_each_field), where they
// read it from (Source), its bounds (box) and which cells it overlaps (Overlap); beside it, in the
// namespace of an instruction set, how rays intersect it.

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "kernel/shapes/cone.hpp"
#include "kernel/shapes/plane.hpp"
#include "kernel/shapes/sphere.hpp"
#include "kernel/shapes/triangle.hpp"

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

// Which primitive an id is.

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

// The primitives of a scene as plain pointers.

template <class Shape>
struct ArraysOf : Shape::Arrays {};

/// The primitives of each kind by index.
struct GeometryView : PerShape<ArraysOf, Shapes> {
  PrimitiveIds ids;
};

/// Primitive i of a kind.
template <class Shape>
typename Shape::template Fields<float> primitive_at(const typename Shape::Arrays& all,
                                                    std::uint32_t i) {
  if constexpr (Shape::kKind == PrimitiveKind::kTriangle) {
    return all.triangle(i);
  } else {
    return one_of<Shape>(all.fields, i);
  }
}

/// Calls visit.operator()<Shape>(fields) for a primitive.
template <class Visit>
auto visit_primitive(const GeometryView& g, std::uint32_t id, const Visit& visit) {
  return visit_shape(Shapes{}, g.ids, id, [&]<class Shape>(std::uint32_t i) {
    return visit.template operator()<Shape>(primitive_at<Shape>(g.of<Shape>(), i));
  });
}

// Exact copies of primitives that stand in no cell: their originals stand there for them.

/// A primitive and one of its copies, which has a higher id.
struct Copy {
  std::uint32_t original, copy;
  friend auto operator<=>(const Copy&, const Copy&) = default;
};

/// Copies in order of their originals, then of their ids. Inlined, or the linker could take another
/// file's.
struct CopyTable {
  const Copy* pair = nullptr;
  std::uint32_t count = 0;

  /// The first pair of an original, if it has() one; others follow.
  [[gnu::always_inline]] std::uint32_t begin(std::uint32_t id) const {
    std::uint32_t first = 0;
    for (std::uint32_t left = count; left > 0;) {
      const std::uint32_t half = left / 2;
      const bool is_less = pair[first + half].original < id;
      first = is_less ? first + half + 1 : first;
      left = is_less ? left - half - 1 : half;
    }
    return first;
  }
  [[gnu::always_inline]] bool has(std::uint32_t i, std::uint32_t id) const {
    return i < count && pair[i].original == id;
  }
};

}  // namespace grelha
