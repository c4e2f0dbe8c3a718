#pragma once
// Clusters of triangles, for winding numbers: what a point sees of each from afar.

#include <cstdint>
#include <vector>

#include "grelha/scene_spans.hpp"
#include "kernel/base/raw_vector.hpp"
#include "kernel/grid/view.hpp"
#include "kernel/shapes/triangle.hpp"

namespace grelha {

/// Eight clusters side by side. With r the way to the center, n the normal of the surface as long
/// as its area, and y places on it from the center, a cluster's solid angle is about
///
///     (sum n r) / |r|^3 + second(r, r) / |r|^5 + third(r, r, r) / |r|^7,
///
/// where second and third are the moments of n y and of n y y, without what is 0 for all r. The
/// factors that a term of them is counted with are in the numbers.
///
/// Source  Barill, Dickson, Schmidt, Levin, Jacobson, "Fast Winding Numbers for Soups and Clouds",
///         2018. The bound of the error is our own: docs/proofs.md.
struct alignas(64) WindingRow {
  double center[3][kBlock];
  double radius[kBlock];     ///< no place is further from the center
  double area[kBlock];       ///< rounded up
  double spread[kBlock];     ///< the sum of the squared distances from the center, rounded up
  double fourth[kBlock];     ///< over |r|^5: no less than what the term of n y y y adds
  double normal[3][kBlock];  ///< the sum
  double second[6][kBlock];  ///< xx yy zz xy xz yz
  double third[10][kBlock];  ///< xxx yyy zzz xxy xxz xyy yyz xzz yzz xyz
};

/// Clusters as the hot loops see them. Cluster k of row r of level 0 is block 8 r + k, of a level
/// above row 8 r + k of the level below.
struct WindingTreeView {
  static constexpr int kMostLevels = 11;
  const WindingRow* rows = nullptr;
  const TriangleBlock* blocks = nullptr;
  std::uint32_t first[kMostLevels] = {};     ///< row of each level; of the last there is one
  std::uint32_t clusters[kMostLevels] = {};  ///< of each level
  int levels = 0;                            ///< 0: there are no triangles
  std::uint32_t triangles = 0;
  double area = 0;  ///< of all triangles, rounded up
};

/// The clusters of a mesh: its triangles in the order of PackedOrder, eight a block. They depend on
/// the triangles alone, not on grids.
struct WindingTree {
  std::vector<WindingRow> rows;
  RawVector<TriangleBlock> blocks;
  WindingTreeView view;

  explicit WindingTree(const GeometrySpans& geometry);  ///< of visible triangles
  WindingTree(const WindingTree&) = delete;             ///< the view points into it
};

}  // namespace grelha
