#pragma once
// CGAL's tree of boxes on the same triangles, where CMake found CGAL.

#include <memory>
#include <span>
#include <vector>

#include "grelha/geometry.hpp"
#include "grelha/rays.hpp"

namespace grelha::perf {

/// An AABB_tree over the triangles of a scene.
class CgalTree {
 public:
  virtual ~CgalTree() = default;
  /// The nearest hit of each ray; t is org to the hit along the largest component of dir.
  virtual void closest(std::span<const Ray> rays, std::span<Hit> hits) const = 0;
};

/// Null without CGAL. `exact`: by its kernel of exact predicates and exact constructions, else by
/// the kernel of exact predicates whose constructions are doubles.
std::unique_ptr<CgalTree> make_cgal_tree(const Scene& scene, bool exact);

}  // namespace grelha::perf
