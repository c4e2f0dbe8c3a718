#pragma once
// What World holds: the built grids and the views of them that the hot loops see.

#include <array>
#include <vector>

#include "kernel/grid.hpp"
#include "kernel/render.hpp"
#include "kernel/shading_view.hpp"

namespace grelha {

class BuildProgress;
struct Plan;

/// Materials one array per component, so that lanes gather what they need and no more; and what
/// those that primitives have ask for.
struct MaterialTable {
  explicit MaterialTable(const SceneSpans& scene);
  MaterialView view() const;
  std::array<std::vector<float>, kMaterialFields> fields;
  bool reflects = false, refracts = false, fresnel = false, emits = false, highlights = false,
       gloss = false;
  bool gains = false;
  /// of light of 1 a point sends an eye at most so much; and what the brightest sends by itself
  float lit = 0, emitted = 0;
};

struct World::Impl {
  SceneSpans scene;
  Primitives primitives;
  std::vector<Grid> grids;
  CellStore outside;
  std::vector<GridView> grid_views;
  MaterialTable materials;
  std::vector<float> lights;  ///< [kLightFloats * count], see ShadingView
  SceneView view;
  ShadingView shading;

  Impl(const SceneSpans& scene, const BuildOptions& options);

 private:
  void fill(Plan& plan, int threads, BuildProgress& progress);
};

}  // namespace grelha
