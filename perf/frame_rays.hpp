#pragma once
// All rays of a picture, kept as a render traced them, to be traced again and nothing else.

#include <array>
#include <string>
#include <vector>

#include "perf/workloads.hpp"

namespace grelha::perf {

/// Rays of one kind, in the runs a render traced together.
struct RaySet {
  struct Run {
    std::size_t first, count;
  };
  RayBuffer rays;
  std::vector<Run> runs;
};

/// Primary, bounce and shadow rays.
using FrameRays = std::array<RaySet, 3>;
inline constexpr std::array<const char*, 3> kFrameKinds{"primary", "bounce", "shadow"};

/// The rays of render(world, camera, options); every way of tracing makes the same ones.
FrameRays rays_of_frame(const World& world, const Camera& camera, RenderOptions options);

/// Every stride-th ray alone.
FrameRays thinned(const FrameRays& frame, std::size_t stride);

/// Seconds that tracing takes, by kind: of the processor for one thread, by the clock for more.
std::array<double, 3> trace_seconds(const World& world,
                                    const Variant& variant,
                                    const TraceOptions& settings,
                                    const FrameRays& frame,
                                    int threads);

/// Since some moment: by the clock, and of this process on all processors, which other programs
/// stretch less.
double now_seconds();
double cpu_seconds();

}  // namespace grelha::perf
