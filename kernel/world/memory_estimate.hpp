#pragma once
// What a build will take, before it does.

#include <cstdint>

#include "kernel/world/plan.hpp"

namespace grelha {

/// What carrying out a plan for a scene takes, the plan's own lists included.
///
/// Method  sixteen thousand primitives of each grid, picked at random, say how many references
///         there will be and how many pairs of them share a cell. From the pairs follows how many
///         blocks of eight are not full. All else are counts.
BuildMemory memory_of(const SceneSpans& scene, const Primitives& p, const Plan& plan);
/// No plan for so many primitives comes near so many bytes: an estimate can be spared.
bool surely_fits(const Primitives& p, std::uint64_t bytes);

}  // namespace grelha
