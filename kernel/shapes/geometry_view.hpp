#pragma once
// The primitives of a scene as plain pointers.

#include "kernel/shapes/ids.hpp"

namespace grelha {

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

}  // namespace grelha
