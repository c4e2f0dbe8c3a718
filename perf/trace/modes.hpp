#pragma once
// Grelha's ways of tracing a set of rays.

#include "perf/ray_sets.hpp"
#include "perf/workloads.hpp"

namespace grelha::perf {

struct GrelhaMode {
  const char* name;
  TraceOptions settings;
};
inline constexpr GrelhaMode kModes[] = {{"packets 256", {.packet = 256}},
                                        {"packets 64", {.packet = 64}},
                                        {"packets 16", {.packet = 16}},
                                        {"single", {.packet = 1}}};

/// What a render takes: of one ray a pixel or point, only those from the camera in packets of 256;
/// see options_for() in shader.hpp.
constexpr std::size_t renders(RayKind kind) {
  const bool alone = RayMaker::to_point(kind) || kind == RayKind::kMirror;
  return alone || kind == RayKind::kScattered ? 1 : 0;
}

}  // namespace grelha::perf
