#pragma once
// Which primitives get which grid, and what that will take, before any list is written.

#include <cstdint>
#include <vector>

#include "kernel/grid/build_progress.hpp"
#include "kernel/grid/grid.hpp"
#include "grelha/world.hpp"

namespace grelha {

struct PlannedGrids {
  std::vector<std::uint32_t> ids;  ///< ascending
  /// over them, laid out and empty: one, or one for near rays and one for far ones
  std::vector<Grid> grids;
};

struct Plan {
  std::vector<PlannedGrids> parts;
  std::vector<std::uint32_t> apart;  ///< what has no grid, ascending
  Box all;                           ///< of everything finite
};

constexpr double kPlanShare = .08;  ///< of the time of a build, before lists are written

int threads_of(const BuildOptions& options);
Plan plan_grids(const Primitives& p, const BuildOptions& options, BuildProgress& progress);

}  // namespace grelha
