#pragma once
// What each variant_*.cpp compiles: the hot loops behind the functions of a Variant. Included once
// per instruction set.

#include "kernel/render/band.hpp"
#include "kernel/render/doubt.hpp"
#include "kernel/query/span.hpp"

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

inline void band(const SceneView& scene,
                 const ShadingView& shading,
                 const FrameView& frame,
                 const Part& part,
                 const BandWork& work,
                 TraceCounts& trace_counts,
                 RayCounts& ray_counts) {
  Counters n;
  RayTally rays;
  render_band(scene, shading, frame, part, work, n, rays);
  tally(n, rays, trace_counts, ray_counts);
}

inline void pixel_runs(const SceneView& scene,
                       const ShadingView& shading,
                       const FrameView& frame,
                       const PixelRun* runs,
                       int count,
                       const BandWork& work,
                       TraceCounts& trace_counts,
                       RayCounts& ray_counts) {
  Counters n;
  RayTally rays;
  render_runs(scene, shading, frame, runs, count, work, n, rays);
  tally(n, rays, trace_counts, ray_counts);
}

inline void doubt(const SceneView& scene,
                  const ShadingView& shading,
                  const FrameView& frame,
                  int x0,
                  int y0,
                  int bounces,
                  std::uint64_t asked,
                  float (&inside)[kTile * kTile],
                  float (&around)[kTile * kTile],
                  TraceCounts& trace_counts) {
  Counters n;
  Watcher watcher(scene, shading, n);
  tile_doubt(watcher, frame, x0, y0, kTile, bounces, asked, inside, around);
  add(n, trace_counts);
}

inline void points(const SceneView& scene,
                   const ShadingView& shading,
                   const FrameView& frame,
                   const PointList& list,
                   const BandWork& work,
                   TraceCounts& trace_counts,
                   RayCounts& ray_counts) {
  Counters n;
  RayTally rays;
  render_points(scene, shading, frame, list, work, n, rays);
  tally(n, rays, trace_counts, ray_counts);
}

inline void powers(const float* x, const float* y, float* out, int count) {
  for (int i = 0; i < count; i += kWidth<Lanes>) {
    alignas(64) float in[2][kWidth<Lanes>], r[kWidth<Lanes>];
    const int left = count - i < kWidth<Lanes> ? count - i : kWidth<Lanes>;
    for (int k = 0; k < kWidth<Lanes>; ++k) {
      in[0][k] = x[i + (k < left ? k : 0)];
      in[1][k] = y[i + (k < left ? k : 0)];
    }
    store(r, power(load<Lanes>(in[0]), load<Lanes>(in[1])));
    for (int k = 0; k < left; ++k)
      out[i + k] = r[k];
  }
}

/// Writes the lanes of the samples left.
inline void store_some(float* p, const Lanes& a, int left) {
  float v[kWidth<Lanes>];
  store(v, a);
  for (int k = 0; k < kWidth<Lanes> && k < left; ++k)
    p[k] = v[k];
}

inline void samples(const SamplePlan& plan,
                    const std::uint32_t* pixel,
                    const std::uint32_t* index,
                    int dimension,
                    const std::uint32_t* key,
                    const Strata& strata,
                    float* u,
                    float* v,
                    int count) {
  for (int i = 0; i < count; i += kWidth<Lanes>) {
    std::uint32_t in[3][kWidth<Lanes>];
    const int left = count - i < kWidth<Lanes> ? count - i : kWidth<Lanes>;
    for (int k = 0; k < kWidth<Lanes>; ++k) {
      const int from = i + (k < left ? k : 0);
      in[0][k] = pixel[from];
      in[1][k] = index[from];
      in[2][k] = key[from];
    }
    const PairOf<Lanes> p = sample_pairs<Lanes>(plan,
                                                load_words<Lanes>(in[0]),
                                                load_words<Lanes>(in[1]),
                                                dimension,
                                                load_words<Lanes>(in[2]),
                                                strata);
    store_some(u + i, p.u, left);
    store_some(v + i, p.v, left);
  }
}

}  // namespace grelha::GRELHA_ISA

#define GRELHA_LOOPS                                                                         \
  {                                                                                          \
    GRELHA_ISA::closest, GRELHA_ISA::occluded, GRELHA_ISA::band, GRELHA_ISA::pixel_runs,     \
        GRELHA_ISA::doubt, GRELHA_ISA::powers, GRELHA_ISA::samples, GRELHA_ISA::camera_rays, \
        GRELHA_ISA::points                                                                   \
  }
