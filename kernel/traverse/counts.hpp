#pragma once
// Counts of tests. Counting changes no answer.

#include "grelha/stats.hpp"
#include "kernel/shapes/shapes.hpp"

namespace grelha::GRELHA_ISA {

/// Counts tests of a kind; those of a kind without a counter are not counted.
template <class Shape>
[[gnu::always_inline]] inline void count_tests(TraceCounts& n, unsigned tests) {
  if constexpr (Shape::kKind == PrimitiveKind::kSphere)
    n.tests.sphere += tests;
  else if constexpr (Shape::kKind == PrimitiveKind::kTriangle)
    n.tests.triangle += tests;
  else if constexpr (Shape::kKind == PrimitiveKind::kCone)
    n.tests.cone += tests;
  else if constexpr (Shape::kKind == PrimitiveKind::kPlane)
    n.tests.plane += tests;
}

/// Replaces TraceCounts when no caller asks for them: clearing these took up to a twentieth of a
/// call for one ray.
struct NoCounts {};

/// Counts the rows of primitives that a ray is tested against.
template <class Shape>
inline void count_rows(TraceCounts& n, int rows, int width) {
  n.rows.primitives += static_cast<unsigned>(rows);
  count_tests<Shape>(n, static_cast<unsigned>(rows * width));
}
template <class Shape>
inline void count_rows(NoCounts&, int, int) {}

}  // namespace grelha::GRELHA_ISA
