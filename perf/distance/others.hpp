#pragma once
// Other trees that find closest points of triangles, each null where CMake did not find it.

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "grelha/distance.hpp"
#include "grelha/geometry.hpp"

namespace grelha::perf {

/// Closest points of the triangles of a scene, by another program.
class OtherTree {
 public:
  virtual ~OtherTree() = default;
  /// Finds the closest point, its distance and its triangle for each point.
  virtual void closest(std::span<const Float3> points, std::span<ClosestPoint> found) const = 0;
};

/// Embree's rtcPointQuery, whose callback computes in float; a scene of quality MEDIUM.
std::unique_ptr<OtherTree> make_embree_tree(const Triangles& triangles);
/// CGAL's AABB tree over Simple_cartesian<double>, with its own hints (a k-d tree of vertices).
std::unique_ptr<OtherTree> make_cgal_tree(const Triangles& triangles);

/// Insides of a closed mesh, by another program.
class OtherInside {
 public:
  virtual ~OtherInside() = default;
  /// inside[i]: 1 if point i is.
  virtual void contains(std::span<const Float3> points, std::span<std::uint8_t> inside) const = 0;
  /// Signed distances; false if it has none.
  virtual bool distances(std::span<const Float3> points, std::span<double> distance) const {
    return points.size() != distance.size();
  }
};
/// CGAL's Side_of_triangle_mesh over exact predicates.
std::unique_ptr<OtherInside> make_cgal_inside(const Triangles& triangles);
/// VTK's vtkSelectEnclosedPoints and vtkImplicitPolyDataDistance.
std::unique_ptr<OtherInside> make_vtk_inside(const Triangles& triangles);

/// Prints the rows of insides of a mesh; false: some answer differs from the others.
bool print_insides(const std::string& name,
                   const Scene& scene,
                   const std::string& points,
                   std::span<const Float3> asked,
                   int rounds);

}  // namespace grelha::perf
