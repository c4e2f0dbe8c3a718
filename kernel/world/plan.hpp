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
/// The room around primitives for rays that start within `reach` of their box on each axis, `reach`
/// no less than its diagonal. Such rays are at most 1 + sqrt 3 reaches from any of them. A float
/// test is off by at most 62 eps of that distance, and a walk by 32 eps of the reach (derived in
/// docs/numerics.md).
double pad_of(double reach);
/// All finite primitives that have a place.
std::vector<std::uint32_t> sound_ids(const Primitives& p);
Plan plan_grids(const Primitives& p, const BuildOptions& options, BuildProgress& progress);

}  // namespace grelha
