#pragma once
// The hot loops behind the functions of a Variant, as each variant_*.cpp compiles them. Included
// once per instruction set.

#include "kernel/shade/strip.hpp"
#include "kernel/query/loops.hpp"

namespace grelha::GRELHA_ISA {

inline void tally(const Counters& n,
                  const RayTally& rays,
                  TraceCounts& trace_counts,
                  RayCounts& ray_counts) {
  add(n, trace_counts);
  ray_counts.primary += rays.primary;
  ray_counts.shadow += rays.shadow;
  ray_counts.reflection += rays.reflection;
  ray_counts.refraction += rays.refraction;
}

inline void strip(const SceneView& scene,
                  const ShadingView& shading,
                  const FrameView& frame,
                  const Part& part,
                  const StripWork& work,
                  TraceCounts& trace_counts,
                  RayCounts& ray_counts) {
  Counters n;
  RayTally rays;
  render_strip(scene, shading, frame, part, work, n, rays);
  tally(n, rays, trace_counts, ray_counts);
}

inline void pixel_runs(const SceneView& scene,
                       const ShadingView& shading,
                       const FrameView& frame,
                       const PixelRun* runs,
                       int count,
                       const StripWork& work,
                       TraceCounts& trace_counts,
                       RayCounts& ray_counts) {
  Counters n;
  RayTally rays;
  render_runs(scene, shading, frame, runs, count, work, n, rays);
  tally(n, rays, trace_counts, ray_counts);
}

inline void points(const SceneView& scene,
                   const ShadingView& shading,
                   const FrameView& frame,
                   const PointList& list,
                   const StripWork& work,
                   TraceCounts& trace_counts,
                   RayCounts& ray_counts) {
  Counters n;
  RayTally rays;
  render_points(scene, shading, frame, list, work, n, rays);
  tally(n, rays, trace_counts, ray_counts);
}

extern const VariantLoops kLoops;
const VariantLoops kLoops{.closest = closest,
                          .occluded = occluded,
                          .closest_one = closest_one,
                          .occluded_one = occluded_one,
                          .render_strip = strip,
                          .render_runs = pixel_runs,
                          .render_points = points};

}  // namespace grelha::GRELHA_ISA
