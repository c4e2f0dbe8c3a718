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
#include "kernel/scene/materials.hpp"
#include "kernel/scene/shading_view.hpp"

namespace grelha {

class BuildProgress;
struct Plan;

struct World::Impl {
  std::vector<std::uint32_t> no_materials;  ///< zeros, for kinds without material indices
  SceneSpans scene;
  Primitives primitives;
  std::vector<Grid> grids;
  CellStore outside;
  std::vector<Copy> copies;
  std::vector<GridView> grid_views;
  MaterialTable materials;
  std::vector<float> lights;  ///< [kLightFloats * count], see ShadingView
  SceneView view;
  ShadingView shading;
  Lazy<MeshCheck> mesh_check;
  Lazy<WindingTree> winding_tree;

  Impl(const SceneSpans& scene, const BuildOptions& options);
  /// Everything built beside the scene.
  std::size_t bytes() const;

 private:
  void fill(Plan& plan, int threads, BuildProgress& progress);
  void view_primitives();
  void view_copies();
  void view_grids(const Box& all);
  void set_lights();
  void set_materials();
};

}  // namespace grelha
