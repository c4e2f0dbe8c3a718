#pragma once
// The contents of World: the built grids and the views that the hot loops read.

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "grelha/mesh_check.hpp"
#include "grelha/world.hpp"
#include "kernel/grid/grid.hpp"
#include "kernel/grid/plan.hpp"
#include "kernel/world/winding_tree.hpp"
#include "kernel/scene/tables.hpp"
#include "kernel/scene/shading_view.hpp"

namespace grelha {

/// A value that the first thread to ask for it makes, while others wait. If that throws, the next
/// one tries again.
template <class T>
class Lazy {
 public:
  /// The value is made of the return value of `arguments`.
  template <class Arguments>
  const T& get(const Arguments& arguments) const {
    std::call_once(once_, [&] { value_.emplace(arguments()); });
    return *value_;
  }

 private:
  mutable std::once_flag once_;
  mutable std::optional<T> value_;
};

class BuildProgress;

/// A grid, and the ids of its primitives; no ranges: they are too scattered to tell.
struct BuiltGrid {
  Grid grid;
  std::vector<IdRange> ids;
};

struct World::Impl {
  /// zeros, for kinds without material indices; at least as many as the largest of them has
  std::shared_ptr<const std::vector<std::uint32_t>> default_material_ids;
  SceneSpans scene;
  Primitives primitives;
  std::vector<std::shared_ptr<const BuiltGrid>> grids;   ///< an update may share some
  std::vector<std::shared_ptr<const BuiltGrid>> hidden;  ///< over objects that no query finds
  PlanMemory planned;
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
  using SharedGrid = std::shared_ptr<const BuiltGrid>;
  std::vector<IdRange> ids_of(std::span<const Object> objects) const;
  SharedGrid find_same(const BuiltGrid& wanted) const;
  PlanMemory memory_of_unmoved(std::span<const Object> moved) const;
  void fill(Plan& plan,
            int threads,
            BuildProgress& progress,
            const Impl* before,
            std::span<const IdRange> moved);
  void keep_hidden(const Impl& before, std::span<const IdRange> moved);
  void view_primitives();
  void view_copies();
  void view_grids(const Box& all);
  void set_materials();
};

}  // namespace grelha
