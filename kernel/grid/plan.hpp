#pragma once
// Decides which primitives get which grid, and what that will take, before any list is written.

#include <cstdint>
#include <optional>
#include <vector>

#include "kernel/grid/build_progress.hpp"
#include "kernel/grid/grid.hpp"
#include "kernel/grid/grid_layout.hpp"
#include "kernel/grid/id_ranges.hpp"
#include "grelha/world.hpp"

namespace grelha {

struct GridPlan {
  std::vector<std::uint32_t> ids;  ///< ascending
  Grid grid;                       ///< over them, laid out and empty
};

/// Primitives that are planned together, and what was found of them.
struct PlannedGroup {
  std::vector<IdRange> ids;
  Extent extent;
  std::optional<Grid> grid;  ///< over all of them, laid out and empty
};

/// What the next plan of a scene that moves takes over.
struct PlanMemory {
  /// Objects that get grids of their own before others do, the first before the next.
  std::vector<Object> own;
  std::vector<PlannedGroup> groups;
  // grids are of use to a plan of as many groups, of this density in a scene of this diagonal
  std::size_t group_count = 0;
  double density = 0, diagonal = 0;
};

struct Plan {
  std::vector<GridPlan> parts;
  std::vector<std::uint32_t> apart;  ///< ids without a grid, ascending
  Box all;                           ///< of everything finite
  PlanMemory memory;
};

constexpr double kPlanShare = .08;  ///< of the time of a build, before lists are written

int threads_of(const BuildOptions& options);
/// The pad around primitives for rays that start within `near_distance` of their box on each axis,
/// `near_distance` no less than its diagonal. Such rays are at most 1 + sqrt 3 near distances from
/// any primitive. A walk in float is off by at most 32 u of the near distance, and by as much along
/// its way (derived in docs/numerics.md).
double pad_of(double near_distance);
/// All finite primitives that have a position.
std::vector<std::uint32_t> valid_ids(const Primitives& p);
Plan plan_grids(const Primitives& p,
                const BuildOptions& options,
                BuildProgress& progress,
                const PlanMemory& before = {});

}  // namespace grelha
