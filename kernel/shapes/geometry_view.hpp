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

}  // namespace grelha
