#pragma once
// Which primitives get which grid, and what that will take, before any list is written.

#include <cstdint>
#include <vector>

#include "kernel/build_progress.hpp"
#include "kernel/grid.hpp"
#include "kernel/render.hpp"

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

/// What carrying out a plan for a scene takes, the plan's own lists included.
///
/// Method  sixteen thousand primitives of each grid, picked at random, say how many references
///         there will be, and how many pairs of them share a cell, from which follows how many
///         blocks of eight are not full. All else are counts.
BuildMemory memory_of(const SceneSpans& scene, const Primitives& p, const Plan& plan);
/// No plan for so many primitives comes near so many bytes: an estimate can be spared.
bool surely_fits(const Primitives& p, std::uint64_t bytes);

}  // namespace grelha
