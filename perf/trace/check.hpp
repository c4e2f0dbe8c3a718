#pragma once
// No way is timed whose answers are wrong.

#include <string>

#include "perf/trace/cell.hpp"
#include "perf/trace/place.hpp"

namespace grelha::perf {

/// Grelha's ways must answer the same bits as each other and, on a sample of rays, as the reference
/// walk; Embree's may differ in kDisagree of the rays. Empty when all is well; else what is wrong.
/// The cell learns how many rays hit, and in how many the robust Embree differs.
std::string check(const Place& place, const RayBuffer& rays, bool any, Cell& cell);

}  // namespace grelha::perf
