#pragma once
// Grelha's ways of tracing a set of rays.

#include "perf/ray_sets.hpp"
#include "perf/workloads.hpp"

namespace grelha::perf {

struct GrelhaMode {
  const char* name;
  TraceOptions settings;
};
/// The first is what a render takes.
inline constexpr GrelhaMode kModes[] = {{"packets 256", {.packet = 256}},
                                        {"packets 64", {.packet = 64}},
                                        {"packets 16", {.packet = 16}},
                                        {"single", {.packet = 1}}};

}  // namespace grelha::perf
