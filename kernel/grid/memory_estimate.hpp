#pragma once
// Estimates the memory that a build will take.

#include <cstdint>

#include "kernel/grid/plan.hpp"

namespace grelha {

/// The memory that carrying out a plan for a scene takes, including the plan's own lists.
///
/// Method  sixteen thousand primitives of each grid, picked at random, tell how many references
///         there will be and how many pairs of primitives share a cell. From the pairs follows how
///         many blocks of eight are not full. All else are counts.
BuildMemory memory_of(const SceneSpans& scene, const Primitives& p, const Plan& plan);
/// True if no plan for so many primitives takes nearly so many bytes: then no estimate is needed.
bool surely_fits(const Primitives& p, std::uint64_t bytes);

}  // namespace grelha
