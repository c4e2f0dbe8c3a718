#pragma once
// The primitives of a scene, and which of them are exact copies of others.

#include <cstdint>
#include <span>
#include <vector>

#include "grelha/scene_spans.hpp"
#include "kernel/shapes/shapes.hpp"

namespace grelha {

template <class Shape>
struct SourceOf {
  typename Shape::Source source;
  explicit SourceOf(const GeometrySpans& g) : source(g) {}
};

/// The caller's arrays, and the data derived from them.
class Primitives {
 public:
  explicit Primitives(const GeometrySpans& geometry);

  GeometrySpans geometry;
  PrimitiveIds ids;

  template <class Shape>
  const typename Shape::Source& of() const {
    return sources_.of<Shape>().source;
  }
  /// Calls visit.operator()<Shape>(index) for what a finite primitive is.
  template <class Visit>
  auto visit(std::uint32_t id, const Visit& visit) const {
    return visit_shape(FiniteShapes{}, ids, id, visit);
  }
  /// Box of a finite primitive.
  Box box(std::uint32_t id) const {
    return visit(id, [&]<class Shape>(std::uint32_t i) { return Shape::box(of<Shape>(), i); });
  }
  PrimitiveKind kind_of(std::uint32_t id) const { return ids.kind_of(id); }
  /// The first id of a finite primitive, and how many there are.
  std::uint32_t first_finite() const { return ids.end(PrimitiveKind::kPlane); }
  std::uint32_t finite_count() const { return ids.end() - first_finite(); }

 private:
  PerShape<SourceOf, Shapes> sources_;
};

/// Finds, among some finite primitives (ids ascending), the copies of another one with a lower id:
/// the numbers that a test reads have the same bits. If two shapes have the same hash, a copy may
/// be missed.
std::vector<Copy> find_duplicates(const Primitives& p, std::span<const std::uint32_t> ids);

/// The planes behind the last one that is no copy.
std::vector<Copy> find_last_copies(const PlaneSpans& planes);

}  // namespace grelha
