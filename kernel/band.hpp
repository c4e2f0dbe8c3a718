#pragma once
// One band of image rows from camera to finished sums: no recursion, bounces wait on a stack and are traced in batches.

#include "kernel/shade.hpp"

namespace grelha::GRELHA_ISA {

/// Rays that march together best: reflected ones and refracted ones, each in the order of the points they left. Sorting by
/// direction as well scatters neighbours and costs more than it brings (docs/performance.md).
inline constexpr int kClasses = 2;

/// Directions of the rays through the centres of a tile's pixels, by rows; returns how many were put behind `count`.
inline int tile_rays(const FrameView& f, Batch& b, int count, int x0, int x1, int y0, int y1, int band_top) {
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x, ++count) {
      const float sx = (static_cast<float>(x) + .5f) - .5f * static_cast<float>(f.width);
      const float sy = .5f * static_cast<float>(f.height) - (static_cast<float>(y) + .5f);
      b.ox[count] = f.eye[0], b.oy[count] = f.eye[1], b.oz[count] = f.eye[2];
      const Vec3<float> d = normalize(Vec3<float>{(f.forward[0] + sx * f.right[0]) + sy * f.up[0],
                                                  (f.forward[1] + sx * f.right[1]) + sy * f.up[1],
                                                  (f.forward[2] + sx * f.right[2]) + sy * f.up[2]});
      b.dx[count] = d.x, b.dy[count] = d.y, b.dz[count] = d.z;
      b.wr[count] = b.wg[count] = b.wb[count] = 1;
      b.pixel[count] = static_cast<std::uint32_t>((y - band_top) * f.width + x);
      b.depth[count] = 1;
    }
  return count;
}

/// One ray of a pixel: sample `index`, at its place in the pixel and, if there is a lens, on the lens.
[[gnu::noinline]] inline void sampled_ray(const FrameView& f, const SamplePlan& plan, Batch& b, int at, int x, int y, std::uint32_t index, int band_top) {
  const std::uint32_t pixel = static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(f.width) + static_cast<std::uint32_t>(x);
  Pair in{.5f, .5f};
  if (plan.samples > 1) in = sample_pair(plan, pixel, index, 0, 0, plan.pixel_strata);
  const float sx = (static_cast<float>(x) + in.u) - .5f * static_cast<float>(f.width);
  const float sy = .5f * static_cast<float>(f.height) - (static_cast<float>(y) + in.v);
  const Vec3<float> eye{f.eye[0], f.eye[1], f.eye[2]};
  Vec3<float> d{(f.forward[0] + sx * f.right[0]) + sy * f.up[0], (f.forward[1] + sx * f.right[1]) + sy * f.up[1],
                (f.forward[2] + sx * f.right[2]) + sy * f.up[2]};
  Vec3<float> org = eye;
  if (f.lens) {
    const Pair p = disc_point(sample_pair(plan, pixel, index, plan.lens, 0, plan.pixel_strata));
    const Vec3<float> on{p.u * f.lens_right[0] + p.v * f.lens_up[0], p.u * f.lens_right[1] + p.v * f.lens_up[1],
                         p.u * f.lens_right[2] + p.v * f.lens_up[2]};
    org = eye + on, d = f.focus * d - on;
  }
  d = normalize(d);
  b.ox[at] = org.x, b.oy[at] = org.y, b.oz[at] = org.z;
  b.dx[at] = d.x, b.dy[at] = d.y, b.dz[at] = d.z;
  b.wr[at] = b.wg[at] = b.wb[at] = 1;
  b.pixel[at] = static_cast<std::uint32_t>((y - band_top) * f.width + x);
  b.depth[at] = 1, b.sample[at] = index, b.path[at] = 0;
}

/// Takes the youngest rays off the stack into the batch, class by class (a stable counting sort); ends[c] is where class c
/// ends.
inline void pop(RayStack& stack, Batch& b, int most, bool sampled, int (&ends)[kClasses]) {
  const int n = stack.size < most ? stack.size : most, at = stack.size - n;
  unsigned char of[kBatch];
  int next[kClasses] = {};
  for (int i = 0; i < n; ++i) {
    of[i] = stack.depth[at + i] & kRefracted ? 1 : 0;
    ++next[of[i]];
  }
  for (int c = 0, sum = 0; c < kClasses; ++c) {
    const int here = next[c];
    next[c] = sum, sum += here, ends[c] = sum;
  }
  for (int i = 0; i < n; ++i) {
    const int from = at + i, to = next[of[i]]++;
    b.ox[to] = stack.ox[from], b.oy[to] = stack.oy[from], b.oz[to] = stack.oz[from];
    b.dx[to] = stack.dx[from], b.dy[to] = stack.dy[from], b.dz[to] = stack.dz[from];
    b.wr[to] = stack.wr[from], b.wg[to] = stack.wg[from], b.wb[to] = stack.wb[from];
    b.pixel[to] = stack.pixel[from], b.depth[to] = stack.depth[from] & ~kRefracted;
    if (sampled) b.sample[to] = stack.sample[from], b.path[to] = stack.path[from];
  }
  stack.size = at;
}

/// Shades `count` camera rays and all they lead to.
inline void finish_batch(const Shader& shader, RayStack& stack, int count) {
  shader.rays.primary += static_cast<unsigned>(count);
  shade_batch(shader, stack, &count, 1, 64);
  int ends[kClasses];
  while (stack.size > 0) {
    pop(stack, shader.b, shader.work.take, shader.work.plan.on, ends);
    shade_batch(shader, stack, ends, kClasses, 16);
  }
}

/// Renders rows [y0, y1), at most kBandRows, into work.sums.
///
/// Depths never fall towards the top of the stack, and rays of depth d + 1 are only added when fewer than `take` of them
/// are there, by at most c take, c = 2 or with rough mirrors gloss_rays + 2 rays a hit: the stack holds at most
/// c kBatch + c take (depth - 2) rays however the light bounces.
inline void render_band(const SceneView& scene, const ShadingView& shading, const FrameView& frame, int y0, int y1,
                        const BandWork& work, Counters& counters, RayTally& rays) {
  Batch& b = *work.batch;
  const Shader shader{scene, shading, work, counters, rays, b};
  RayStack stack = work.stack;
  stack.size = 0;
  const auto finish = [&](int count) { finish_batch(shader, stack, count); };
  int count = 0;
  for (int x0 = 0; x0 < frame.width; x0 += kTile) {
    const int x1 = x0 + kTile < frame.width ? x0 + kTile : frame.width;
    if (work.plan.on) {  // all samples of a pixel next to each other: they are what goes together best
      for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x)
          for (int i = 0; i < work.plan.samples; ++i) {
            sampled_ray(frame, work.plan, b, count, x, y, static_cast<std::uint32_t>(i), y0);
            if (++count == kBatch) finish(count), count = 0;
          }
      continue;
    }
    count = tile_rays(frame, b, count, x0, x1, y0, y1, y0);
    if (count + kTile * kBandRows > kBatch) finish(count), count = 0;
  }
  if (count > 0) finish(count);
}

}  // namespace grelha::GRELHA_ISA
