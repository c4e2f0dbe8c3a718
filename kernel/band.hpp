#pragma once
// One band of image rows from camera to finished sums: no recursion, bounces wait on a stack and are traced in batches.

#include "kernel/shade.hpp"

namespace grelha::GRELHA_ISA {

/// Rays that march together best: reflected ones and refracted ones, each in the order of the points they left. Sorting by
/// direction as well scatters neighbours and costs more than it brings (docs/performance.md).
inline constexpr int kClasses = 2;

/// Directions of the rays through the centres of a tile's pixels, in its order; returns how many were put behind `count`.
inline int tile_rays(const FrameView& f, Batch& b, int count, int x0, int x1, int y0, int y1, int band_top) {
  for (int k = 0; k < kTile * kTile; ++k) {
    const int x = x0 + tile_x(k), y = y0 + tile_y(k);
    if (x >= x1 || y >= y1) continue;
    const float sx = (static_cast<float>(x) + .5f) - .5f * static_cast<float>(f.width);
    const float sy = .5f * static_cast<float>(f.height) - (static_cast<float>(y) + .5f);
    b.ox[count] = f.eye[0], b.oy[count] = f.eye[1], b.oz[count] = f.eye[2];
    const Vec3<float> d = normalize(Vec3<float>{(f.forward[0] + sx * f.right[0]) + sy * f.up[0],
                                                (f.forward[1] + sx * f.right[1]) + sy * f.up[1],
                                                (f.forward[2] + sx * f.right[2]) + sy * f.up[2]});
    b.dx[count] = d.x, b.dy[count] = d.y, b.dz[count] = d.z;
    b.wr[count] = b.wg[count] = b.wb[count] = 1;
    b.pixel[count] = static_cast<std::uint32_t>((y - band_top) * f.width + x);
    b.depth[count++] = 1;
  }
  return count;
}

/// Writes the lanes of the samples left.
inline void store_some(float* p, const Lanes& a, int left) {
  if (left >= kWidth<Lanes>) return store(p, a);
  float v[kWidth<Lanes>];
  store(v, a);
  for (int k = 0; k < left; ++k) p[k] = v[k];
}

/// Rays of one pixel from `at` on: samples first, first + 1, ..., each at its place in the pixel and, if there is a lens, on
/// the lens. Their light goes to sum `sum`.
[[gnu::noinline]] inline void sampled_rays(const FrameView& f, const SamplePlan& plan, Batch& b, int at, int x, int y, std::uint32_t first, int count,
                                           std::uint32_t sum) {
  const auto splat = [](const float (&v)[3]) { return Vec3<Lanes>{Lanes(v[0]), Lanes(v[1]), Lanes(v[2])}; };
  const Vec3<Lanes> eye = splat(f.eye), forward = splat(f.forward), right = splat(f.right), up = splat(f.up);
  const Lanes across(static_cast<float>(x)), down(static_cast<float>(y));
  const Lanes half_width(.5f * static_cast<float>(f.width)), half_height(.5f * static_cast<float>(f.height));
  const Words<Lanes> zero{}, pixel = zero + (static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(f.width) + static_cast<std::uint32_t>(x));
  for (int i = 0; i < count; i += kWidth<Lanes>) {
    const Words<Lanes> index = counted_words<Lanes>(first + static_cast<std::uint32_t>(i));
    PairOf<Lanes> in{Lanes(.5f), Lanes(.5f)};
    if (plan.samples > 1) in = sample_pairs<Lanes>(plan, pixel, index, 0, zero, plan.pixel_strata);
    const Lanes sx = (across + in.u) - half_width, sy = half_height - (down + in.v);
    Vec3<Lanes> d = (forward + sx * right) + sy * up, org = eye;
    if (f.lens) {
      const PairOf<Lanes> p = disc_point(sample_pairs<Lanes>(plan, pixel, index, plan.lens, zero, plan.pixel_strata));
      const Vec3<Lanes> on = p.u * splat(f.lens_right) + p.v * splat(f.lens_up);
      org = eye + on, d = Lanes(f.focus) * d - on;
    }
    d = normalize(d);
    const int to = at + i, left = count - i;
    store_some(b.ox + to, org.x, left), store_some(b.oy + to, org.y, left), store_some(b.oz + to, org.z, left);
    store_some(b.dx + to, d.x, left), store_some(b.dy + to, d.y, left), store_some(b.dz + to, d.z, left);
  }
  for (int i = 0; i < count; ++i) {
    b.wr[at + i] = b.wg[at + i] = b.wb[at + i] = 1;
    b.pixel[at + i] = sum, b.depth[at + i] = 1, b.sample[at + i] = first + static_cast<std::uint32_t>(i), b.path[at + i] = 0;
  }
}

/// Takes the youngest rays off the stack into the batch, class by class, in their order; ends[c] is where class c ends.
inline void pop(RayStack& stack, Batch& b, int most, bool sampled, int (&ends)[kClasses]) {
  const int n = stack.size < most ? stack.size : most, top = stack.size;
  stack.size -= n;
  int to = 0;
  for (int c = 0; c < kClasses; ++c) {
    for (int i = 0; i < n; i += kWidth<Lanes>) {
      const int from = stack.size + i;
      const Words<Lanes> depth = load_words<Lanes>(stack.depth + from);
      const unsigned refracted = bits(mask_of(Words<Lanes>(depth >= kRefracted))), lanes = lanes_of(from, top);
      const Chosen here((c == 0 ? ~refracted : refracted) & lanes);
      if (here.count() == 0) continue;
      const auto move = [&](float* into, const float* of) { here.store(into + to, load<Lanes>(of + from)); };
      const auto move_words = [&](std::uint32_t* into, const std::uint32_t* of) { here.store(into + to, load_words<Lanes>(of + from)); };
      move(b.ox, stack.ox), move(b.oy, stack.oy), move(b.oz, stack.oz);
      move(b.dx, stack.dx), move(b.dy, stack.dy), move(b.dz, stack.dz);
      move(b.wr, stack.wr), move(b.wg, stack.wg), move(b.wb, stack.wb);
      move_words(b.pixel, stack.pixel), here.store(b.depth + to, depth & ~kRefracted);
      if (sampled) move_words(b.sample, stack.sample), move_words(b.path, stack.path);
      to += here.count();
    }
    ends[c] = to;
  }
}

/// Camera rays [0, count) of the batch and all that comes of them. The stack is empty before and after.
inline void follow(const Shader& s, RayStack& stack, int count) {
  s.rays.primary += static_cast<unsigned>(count);
  shade_batch(s, stack, &count, 1, Phase::primary);
  int ends[kClasses];
  while (stack.size > 0) {
    enter(s.work, Phase::children);
    pop(stack, s.b, s.work.take, s.work.plan.on, ends);
    shade_batch(s, stack, ends, kClasses, Phase::bounce);
  }
  enter(s.work, Phase::camera);
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
  const auto finish = [&](int count) { follow(shader, stack, count); };
  int count = 0;
  for (int x0 = 0; x0 < frame.width; x0 += kTile) {
    const int x1 = x0 + kTile < frame.width ? x0 + kTile : frame.width;
    if (work.plan.on) {  // all samples of a pixel next to each other: they are what goes together best
      for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x)
          for (int i = 0; i < work.plan.samples;) {
            const int left = work.plan.samples - i, room = kBatch - count, n = left < room ? left : room;
            sampled_rays(frame, work.plan, b, count, x, y, static_cast<std::uint32_t>(i), n, static_cast<std::uint32_t>((y - y0) * frame.width + x));
            i += n, count += n;
            if (count == kBatch) finish(count), count = 0;
          }
      continue;
    }
    count = tile_rays(frame, b, count, x0, x1, y0, y1, y0);
    if (count + kTile * kBandRows > kBatch) finish(count), count = 0;
  }
  if (count > 0) finish(count);
}

/// Runs of samples; part p of run r goes into sum kParts r + p of work.sums, whose pixel work.pixels must name.
inline void render_runs(const SceneView& scene, const ShadingView& shading, const FrameView& frame, const PixelRun* runs, int count,
                        const BandWork& work, Counters& counters, RayTally& rays) {
  Batch& b = *work.batch;
  const Shader shader{scene, shading, work, counters, rays, b};
  RayStack stack = work.stack;
  stack.size = 0;
  int filled = 0;
  for (int r = 0; r < count; ++r) {
    const PixelRun& run = runs[r];
    const int x = static_cast<int>(run.pixel % static_cast<std::uint32_t>(frame.width)), y = static_cast<int>(run.pixel / static_cast<std::uint32_t>(frame.width));
    const int all = static_cast<int>(run.count), part = all / kParts;
    for (int i = 0; i < all;) {
      const int room = kBatch - filled, n = all - i < room ? all - i : room;
      sampled_rays(frame, work.plan, b, filled, x, y, run.first + static_cast<std::uint32_t>(i), n, 0);
      for (int k = 0; k < n; ++k) b.pixel[filled + k] = static_cast<std::uint32_t>(r * kParts + (i + k) / part);
      i += n, filled += n;
      if (filled == kBatch) follow(shader, stack, filled), filled = 0;
    }
  }
  if (filled > 0) follow(shader, stack, filled);
}

}  // namespace grelha::GRELHA_ISA
