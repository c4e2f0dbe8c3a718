#pragma once
// The arrays one thread shades in: a batch of rays, their hits, the shadow rays from these, and the
// rays that wait for their turn.

#include <cstdint>

namespace grelha {

inline constexpr int kBatch = 512;     ///< rays shaded together
inline constexpr int kCacheLine = 16;  ///< floats
/// Length of an array of a batch: a cache line more than a power of two. A cache keeps few lines
/// whose addresses are equal modulo 4 KiB, and each hit writes to some thirty arrays side by side.
/// With the odd line all these stay in the cache.
inline constexpr int kBatchRow = kBatch + kCacheLine;
/// Vectors of a batch, an array per component.
struct Rows3 {
  alignas(64) float x[kBatchRow], y[kBatchRow], z[kBatchRow];
};

/// The same for longer arrays that stand elsewhere.
struct Columns3 {
  float *x, *y, *z;
};

/// Set in the depth of a waiting ray that was refracted.
inline constexpr std::uint32_t kRefracted = 1u << 31;

/// Rays waiting for their turn, last in first out. Arrays of `capacity` each.
struct RayStack {
  Columns3 org, dir, weight;
  float* share;  ///< only where keeps_shares()
  std::uint32_t *pixel, *depth;
  std::uint32_t *sample, *path;  ///< only when the plan is on
  int size, capacity;
};

/// The rays.
struct BatchRays {
  Rows3 org, dir;
  alignas(64) float t[kBatchRow];  ///< t of the hit, if its surface is computed from t
  Rows3 weight;
  alignas(64) float share[kBatchRow];
  std::uint32_t id[kBatchRow], pixel[kBatchRow], depth[kBatchRow];
  std::uint32_t sample[kBatchRow];  ///< of its pixel
  std::uint32_t path[kBatchRow];    ///< which bounces led here (0: none)
};

/// The hits of the rays, without the misses.
struct BatchHits {
  Rows3 point;                          ///< on the surface
  Rows3 normal;                         ///< geometric, unit, towards the viewer
  Rows3 shading;                        ///< normal for shading, unit, towards the viewer
  Rows3 viewer;                         ///< unit vector to it
  alignas(64) float offset[kBatchRow];  ///< how far along the normal a ray must start so as not to
                                        ///< hit its own surface
  alignas(64) float inside[kBatchRow];  ///< 1: hit from within
  Rows3 weight;                         ///< of the light from this point
  alignas(64) float share[kBatchRow];   ///< see split()
  std::uint32_t pixel[kBatchRow], depth[kBatchRow], material[kBatchRow];
  std::uint32_t sample[kBatchRow], path[kBatchRow];
  Rows3 color;  ///< of vertices, mixed: times diffuse and emission; only with ShadingView::colored
};

/// Shadow rays and the light each lets through.
struct BatchShadows {
  Rows3 org, dir;
  Rows3 light;
  std::uint32_t id[kBatchRow];  ///< a primitive in the way
  std::uint32_t pixel[kBatchRow];
};

/// One thread's arrays for one batch; the caller allocates one a thread.
struct Batch {
  BatchRays rays;
  BatchHits hits;
  BatchShadows shadows;
};

}  // namespace grelha
