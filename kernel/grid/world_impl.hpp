#pragma once
// The contents of World: the built grids and the views that the hot loops read.

#include <array>
#include <memory>
#include <vector>

#include "grelha/mesh_check.hpp"
#include "grelha/world.hpp"
#include "kernel/base/lazy.hpp"
#include "kernel/grid/grid.hpp"
#include "kernel/grid/winding_tree.hpp"
#include "kernel/scene/lights.hpp"
#include "kernel/scene/materials.hpp"
#include "kernel/scene/shading_view.hpp"

namespace grelha {

class BuildProgress;
struct Plan;

/// A grid, and the range of its primitives' ids; `count` is 0 if they are no range.
struct BuiltGrid {
  Grid grid;
  std::uint32_t first_id = 0, count = 0;
};

struct World::Impl {
  std::vector<std::uint32_t> no_materials;  ///< zeros, for kinds without material indices
  SceneSpans scene;
  Primitives primitives;
  std::vector<std::shared_ptr<const BuiltGrid>> grids;  ///< an update may share some
  CellStore outside;
  std::vector<Copy> copies;
  std::vector<GridView> grid_views;
  MaterialTable materials;
  LightTable lights;
  SceneView view;
  ShadingView shading;
  Lazy<MeshCheck> mesh_check;
  Lazy<WindingTree> winding_tree;

  /// `before`: what may have grids to be shared, over all but the triangles that moved; or null.
  Impl(const SceneSpans& scene,
       const BuildOptions& options,
       const Impl* before = nullptr,
       std::span<const Object> moved = {});
  /// Everything built beside the scene.
  std::size_t bytes() const;

 private:
  std::shared_ptr<const BuiltGrid> find_unmoved(const BuiltGrid& planned,
                                                std::span<const Object> moved) const;
  void fill(Plan& plan,
            int threads,
            BuildProgress& progress,
            const Impl* before,
            std::span<const Object> moved);
  void view_primitives();
  void view_copies();
  void view_grids(const Box& all);
  void set_materials();
};

}  // namespace grelha
