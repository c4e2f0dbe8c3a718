#pragma once
// One band of image rows from camera to finished sums: no recursion, bounces wait on a stack and
// are traced in batches.

#include <algorithm>

#include "grelha/part.hpp"
#include "kernel/render/shade.hpp"

namespace grelha::GRELHA_ISA {

/// Rays that march together best: reflected ones and refracted ones, each in the order of the
/// points they left. Sorting by direction as well scatters neighbours and costs more than it brings
/// (docs/performance.md).
inline constexpr int kClasses = 2;

/// Makes camera rays [0, count) of the batch. Each goes through a place of the picture, which ox
/// and oy hold, its pixel or point is that of its sum, and `sample` its number there. `in_pixels`:
/// the place is a pixel's upper left corner, and the ray goes through the pixel's centre or is one
/// of its samples; otherwise it goes through the place. Writes whole registers.
[[gnu::noinline]] inline void camera_rays(const FrameView& f,
                                          const BandWork& work,
                                          int count,
                                          bool in_pixels) {
  Batch& b = *work.batch;
  const SamplePlan& plan = work.plan;
  const Vec3<Lanes> eye = splat(f.eye), forward = splat(f.forward), right = splat(f.right),
                    up = splat(f.up);
  const Lanes half_width(.5f * static_cast<float>(f.width)),
      half_height(.5f * static_cast<float>(f.height));
  const Lanes middle(in_pixels ? .5f : 0.f), one(1);
  const Words<Lanes> zero{};
  for (int i = 0; i < count; i += kWidth<Lanes>) {
    const Words<Lanes> pixel = pixels_of(work, load_words<Lanes>(b.pixel + i)),
                       index = load_words<Lanes>(b.sample + i);
    PairOf<Lanes> in{middle, middle};
    if (in_pixels && plan.samples > 1)
      in = sample_pairs<Lanes>(plan, pixel, index, 0, zero, plan.pixel_strata);
    const Lanes sx = (load<Lanes>(b.ox + i) + in.u) - half_width,
                sy = half_height - (load<Lanes>(b.oy + i) + in.v);
    Vec3<Lanes> d = (forward + sx * right) + sy * up, org = eye;
    if (f.lens) {
      const PairOf<Lanes> p =
          disc_point(sample_pairs<Lanes>(plan, pixel, index, plan.lens, zero, plan.pixel_strata));
      const Vec3<Lanes> on = p.u * splat(f.lens_right) + p.v * splat(f.lens_up);
      org = eye + on;
      d = Lanes(f.focus) * d - on;
    }
    d = normalize(d);
    store(b.ox + i, org.x);
    store(b.oy + i, org.y);
    store(b.oz + i, org.z);
    if (work.in_double)
      for (float* const low : {b.ox_low, b.oy_low, b.oz_low})
        store(low + i, Lanes(0));
    store(b.dx + i, d.x);
    store(b.dy + i, d.y);
    store(b.dz + i, d.z);
    store(b.wr + i, one);
    store(b.wg + i, one);
    store(b.wb + i, one);
    store_words(b.depth + i, zero + 1u);
    store_words(b.path + i, zero);
  }
}

/// Takes the youngest rays off the stack into the batch, class by class, in their order; ends[c] is
/// where class c ends.
inline void pop(RayStack& stack,
                Batch& b,
                int most,
                bool sampled,
                bool shares,
                bool in_double,
                int (&ends)[kClasses]) {
  const int n = stack.size < most ? stack.size : most, top = stack.size;
  stack.size -= n;
  int to = 0;
  for (int c = 0; c < kClasses; ++c) {
    for (int i = 0; i < n; i += kWidth<Lanes>) {
      const int from = stack.size + i;
      const Words<Lanes> depth = load_words<Lanes>(stack.depth + from);
      const unsigned refracted = bits(mask_of(Words<Lanes>(depth >= kRefracted))),
                     lanes = lanes_of(from, top);
      const Chosen here((c == 0 ? ~refracted : refracted) & lanes);
      if (here.count() == 0)
        continue;
      const auto move = [&](float* into, const float* of) {
        here.store(into + to, load<Lanes>(of + from));
      };
      const auto move_words = [&](std::uint32_t* into, const std::uint32_t* of) {
        here.store(into + to, load_words<Lanes>(of + from));
      };
      move(b.ox, stack.ox);
      move(b.oy, stack.oy);
      move(b.oz, stack.oz);
      if (in_double) {
        move(b.ox_low, stack.ox_low);
        move(b.oy_low, stack.oy_low);
        move(b.oz_low, stack.oz_low);
      }
      move(b.dx, stack.dx);
      move(b.dy, stack.dy);
      move(b.dz, stack.dz);
      move(b.wr, stack.wr);
      move(b.wg, stack.wg);
      move(b.wb, stack.wb);
      if (shares)
        move(b.share, stack.share);
      move_words(b.pixel, stack.pixel);
      here.store(b.depth + to, depth & ~kRefracted);
      if (sampled) {
        move_words(b.sample, stack.sample);
        move_words(b.path, stack.path);
      }
      to += here.count();
    }
    ends[c] = to;
  }
}

/// Camera rays [0, count) of the batch and all that comes of them. The stack is empty before and
/// after.
inline void follow(const Shader& s, RayStack& stack, int count) {
  s.rays.primary += static_cast<unsigned>(count);
  if (keeps_shares(s))
    std::fill(s.b.share, s.b.share + count, 1.f);
  shade_batch(s, stack, &count, 1, Phase::primary);
  int ends[kClasses];
  while (stack.size > 0) {
    enter(s.work, Phase::children);
    pop(stack,
        s.b,
        s.work.take,
        s.work.plan.on,
        keeps_shares(s),
        s.work.in_double != nullptr,
        ends);
    shade_batch(s, stack, ends, kClasses, Phase::bounce);
  }
  enter(s.work, Phase::camera);
}

/// Collects samples of places of the picture and renders them, a full batch at a time; see
/// camera_rays().
class CameraBatch {
 public:
  CameraBatch(const Shader& s, const FrameView& frame, bool in_pixels)
      : s_(s), frame_(frame), stack_(s.work.stack), in_pixels_(in_pixels) {
    stack_.size = 0;
  }
  void add(float x, float y, std::uint32_t sum, std::uint32_t first, std::uint32_t count) {
    Batch& b = s_.b;
    int at = size_;
    for (std::uint32_t i = 0; i < count; ++i) {
      b.ox[at] = x;
      b.oy[at] = y;
      b.pixel[at] = sum;
      b.sample[at] = first + i;
      if (++at < kBatch)
        continue;
      render(at);
      at = 0;
    }
    size_ = at;
  }
  /// Call once, at the end.
  void finish() {
    if (size_ != 0)
      render(size_);
    enter(s_.work, Phase::sums);
  }

 private:
  [[gnu::noinline]] void render(int count) {
    camera_rays(frame_, s_.work, count, in_pixels_);
    follow(s_, stack_, count);
  }

  const Shader& s_;
  const FrameView& frame_;
  RayStack stack_;
  bool in_pixels_;
  int size_ = 0;
};

struct TilePlaces {
  std::uint8_t x[kTile * kTile], y[kTile * kTile];
  constexpr TilePlaces() : x{}, y{} {
    for (int k = 0; k < kTile * kTile; ++k) {
      x[k] = static_cast<std::uint8_t>(tile_x(k));
      y[k] = static_cast<std::uint8_t>(tile_y(k));
    }
  }
};
inline constexpr TilePlaces kTilePlaces;

/// Renders a part of at most kBandRows rows into work.sums.
///
/// Depths never fall towards the top of the stack. Rays of depth d + 1 are only added when fewer
/// than `take` of them are there, and by at most c take. A hit sends c rays: 2, or gloss_rays + 2
/// with rough mirrors. So the stack holds at most c kBatch + c take (depth - 2) rays however the
/// light bounces.
inline void render_band(const SceneView& scene,
                        const ShadingView& shading,
                        const FrameView& frame,
                        const Part& part,
                        const BandWork& work,
                        Counters& counters,
                        RayTally& rays) {
  const int y0 = part.rows.begin, y1 = part.rows.end;
  const Shader shader{scene, shading, work, counters, rays, *work.batch};
  CameraBatch batch(shader, frame, true);
  for (int x0 = 0; x0 < frame.width; x0 += kTile)
    for (int k = 0; k < kTile * kTile; ++k) {
      const int x = x0 + kTilePlaces.x[k], y = y0 + kTilePlaces.y[k];
      if (x >= frame.width || y >= y1)
        continue;
      batch.add(static_cast<float>(x),
                static_cast<float>(y),
                static_cast<std::uint32_t>((y - y0) * frame.width + x),
                static_cast<std::uint32_t>(part.samples.begin),
                static_cast<std::uint32_t>(part.samples.end - part.samples.begin));
    }
  batch.finish();
}

/// Runs of samples; part p of run r goes into sum kParts r + p of work.sums, whose pixel
/// work.pixels must name.
inline void render_runs(const SceneView& scene,
                        const ShadingView& shading,
                        const FrameView& frame,
                        const PixelRun* runs,
                        int count,
                        const BandWork& work,
                        Counters& counters,
                        RayTally& rays) {
  const Shader shader{scene, shading, work, counters, rays, *work.batch};
  CameraBatch batch(shader, frame, true);
  const auto width = static_cast<std::uint32_t>(frame.width);
  for (int r = 0; r < count; ++r)
    for (std::uint32_t p = 0; p < kParts; ++p) {
      const PixelRun& run = runs[r];
      const std::uint32_t part = run.count / kParts;
      batch.add(static_cast<float>(run.pixel % width),
                static_cast<float>(run.pixel / width),
                static_cast<std::uint32_t>(r) * kParts + p,
                run.first + p * part,
                part);
    }
  batch.finish();
}

/// All samples of each point into the point's sum: what adaptive subdivision asks for. Points that
/// stand next to each other make a packet.
inline void render_points(const SceneView& scene,
                          const ShadingView& shading,
                          const FrameView& frame,
                          const PointList& points,
                          const BandWork& work,
                          Counters& counters,
                          RayTally& rays) {
  const Shader shader{scene, shading, work, counters, rays, *work.batch};
  CameraBatch batch(shader, frame, false);
  for (int i = 0; i < points.count; ++i)
    batch.add(points.x[i],
              points.y[i],
              static_cast<std::uint32_t>(i),
              0,
              static_cast<std::uint32_t>(work.plan.samples));
  batch.finish();
}

}  // namespace grelha::GRELHA_ISA
