#pragma once
// How wide a mesh looks where it ends, or turns away.

#include "kernel/marks/mesh_rims.hpp"
#include "kernel/marks/rod.hpp"

namespace grelha {

/// Walks across a mesh as it looks from a viewpoint, straight from the middle of an edge at a rim
/// to the next rim. Between rims its triangles lie side by side.
class RimWalk {
 public:
  /// `v`: of the viewpoints that rims tell of.
  RimWalk(const TriangleSpans& triangles, const MeshRims& rims, std::size_t v, const Place3& from)
      : t_(triangles), rims_(rims), v_(v), from_{from[0], from[1], from[2]} {}

  /// Edge k of triangle i, without a width.
  Rod edge(std::size_t i, std::size_t k) const;
  /// Whether triangle i alone does not tell that the mesh is as wide as `enough` beside that edge.
  bool may_be_thin(std::size_t i, std::size_t k, double enough) const;
  /// What of the mesh lies beside that edge, as wide as the way to the next rim. Where that is
  /// `enough` or more, that is all that it tells; where nobody can tell, the way that was gone.
  Rod strip(std::size_t i, std::size_t k, double enough) const;

 private:
  const TriangleSpans& t_;
  const MeshRims& rims_;
  const std::size_t v_;
  const Triple from_;
};

}  // namespace grelha
