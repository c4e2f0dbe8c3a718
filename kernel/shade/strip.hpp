#pragma once
// One strip of image rows from camera to finished sums: no recursion, bounces wait on a stack and
// are traced in batches.

#include <algorithm>

#include "grelha/part.hpp"
#include "kernel/shade/shade.hpp"
#include "kernel/shade/pixel_box.hpp"

namespace grelha::GRELHA_ISA {

/// Rays that march together best: reflected ones and refracted ones, each in the order of the
/// points they left. Sorting by direction as well scatters neighbours and costs more than it brings
/// (docs/performance.md).
inline constexpr int kClasses = 2;

/// Origins and directions of rays.
struct CameraRays {
  VFloat3 org, dir;
};

/// A camera, the same in each lane.
struct LaneCamera {
  explicit LaneCamera(const FrameView& f)
      : eye(splat(f.eye)),
        forward(splat(f.forward)),
        right(splat(f.right)),
        up(splat(f.up)),
        half_width(.5f * static_cast<float>(f.width)),
        half_height(.5f * static_cast<float>(f.height)),
        parallel(f.parallel) {}

  /// Through positions in the picture, in pixels from its upper left corner.
  CameraRays rays(const VFloat& x, const VFloat& y) const {
    const VFloat sx = x - half_width;
    const VFloat sy = half_height - y;
    if (parallel)
      return {(eye + sx * right) + sy * up, forward};
    return {eye, (forward + sx * right) + sy * up};
  }

  VFloat3 eye, forward, right, up;
  VFloat half_width, half_height;
  bool parallel;
};

/// Rays that start from points of the lens and cross the given ones in focus.
[[gnu::always_inline]] inline CameraRays through_lens(const FrameView& f,
                                                      const CameraRays& pinhole,
                                                      const PairOf<VFloat>& sample) {
  const PairOf<VFloat> p = disc_point(sample);
  const VFloat3 on_lens = p.u * splat(f.lens_right) + p.v * splat(f.lens_up);
  return {pinhole.org + on_lens, VFloat(f.focus) * pinhole.dir - on_lens};
}

/// Stores camera rays i, i + 1, ..., not yet normalized.
[[gnu::always_inline]] inline void store_camera_rays(BatchRays& b,
                                                     int i,
                                                     const CameraRays& rays,
                                                     const VFloat& weight) {
  const VUint zero{};
  store3(b.org, i, rays.org);
  store3(b.dir, i, normalize(rays.dir));
  store3(b.weight, i, {weight, weight, weight});
  store_words(b.depth + i, zero + 1u);
  store_words(b.path + i, zero);
}

/// Moves half of the samples of pixels with boxes into the boxes, and the other half out.
/// Returns the weights: twice the area that each half stands for, so that even light stays even.
[[gnu::always_inline]] inline VFloat move_into_boxes(const VUint& boxes, PairOf<VFloat>& in) {
  const VFloat half(.5f), one(1), two(2), part(1.f / 256);
  const auto side = [&](unsigned shift, std::uint32_t step) {
    return part * small_to_float((boxes >> shift & 255u) + step);
  };
  const VFloat x0 = side(0, 0), y0 = side(8, 0), x1 = side(16, 1), y1 = side(24, 1);
  const VFloat width = x1 - x0, height = y1 - y0, area = width * height, rest = one - area;
  const VMask has = mask_of(VUint(boxes != 0u));
  const VMask aimed = in.u >= half;
  const VFloat u = select(aimed, two * in.u - one, two * in.u);
  // left of the box, above and below it, right of it
  const VFloat along = u * rest, open = one - height;
  const VFloat beside = x0 + (along - x0) / max(open, part);
  const VMask left = along < x0, right = along >= x0 + width * open;
  const VFloat below = in.v * open;
  const VFloat column = select(below < y0, below, below + height);
  const PairOf<VFloat> moved{
      select(aimed, x0 + u * width, select(left, along, select(right, along + area, beside))),
      select(aimed, y0 + in.v * height, select(mask_or(left, right), in.v, column))};
  in = {select(has, moved.u, in.u), select(has, moved.v, in.v)};
  return select(has, two * select(aimed, area, rest), one);
}

/// Makes camera rays [0, count) of the batch. Each goes through a position in the picture, which
/// org.x and org.y hold, its pixel or point is that of its sum, and `sample` its number there.
/// `in_pixels`: the position is a pixel's upper left corner, and the ray goes through the pixel's
/// centre or is one of its samples; otherwise it goes through the position. Writes whole registers.
[[gnu::noinline]] inline void camera_rays(const FrameView& f,
                                          const StripWork& work,
                                          int count,
                                          bool in_pixels) {
  BatchRays& b = work.batch->rays;
  const SamplePlan& plan = work.plan;
  const LaneCamera camera(f);
  const VFloat middle(in_pixels ? .5f : 0.f);
  const VUint zero{};
  for (int i = 0; i < count; i += kSimdWidth) {
    const VUint pixel = pixels_of(work, load_words<VFloat>(b.pixel + i));
    const VUint index = load_words<VFloat>(b.sample + i);
    const auto sample = [&](int dimension) {
      return sample_pairs<VFloat>(plan, pixel, index, dimension, zero, plan.pixel_strata);
    };
    PairOf<VFloat> in{middle, middle};
    if (in_pixels && plan.samples > 1)
      in = sample(0);
    VFloat weight(1);
    if (work.boxes)
      weight = move_into_boxes(words_at(work.boxes, load_words<VFloat>(b.pixel + i)), in);
    const VFloat x = load<VFloat>(b.org.x + i) + in.u;
    const VFloat y = load<VFloat>(b.org.y + i) + in.v;
    CameraRays rays = camera.rays(x, y);
    if (f.lens)
      rays = through_lens(f, rays, sample(plan.lens));
    store_camera_rays(b, i, rays, weight);
  }
}

/// Moves the selected of kSimdWidth rays, from index `from` of a stack on, to index `to` of the
/// batch.
class StackMove {
 public:
  StackMove(const CompressMask& selected, int from, int to)
      : selected_(selected), from_(from), to_(to) {}
  [[gnu::always_inline]] void operator()(Rows3& to, const Columns3& of) const {
    selected_.store(to, to_, load3(of, from_));
  }
  [[gnu::always_inline]] void operator()(float* to, const float* of) const {
    selected_.store(to + to_, load<VFloat>(of + from_));
  }
  [[gnu::always_inline]] void operator()(std::uint32_t* to, const std::uint32_t* of) const {
    selected_.store(to + to_, load_words<VFloat>(of + from_));
  }

 private:
  const CompressMask& selected_;
  int from_, to_;
};

[[gnu::always_inline]] inline void move_rays(const Shader& s,
                                             const RayStack& stack,
                                             const StackMove& move) {
  BatchRays& b = s.b.rays;
  move(b.org, stack.org);
  move(b.dir, stack.dir);
  move(b.weight, stack.weight);
  if (keeps_shares(s))
    move(b.share, stack.share);
  move(b.pixel, stack.pixel);
  if (s.work.plan.on) {
    move(b.sample, stack.sample);
    move(b.path, stack.path);
  }
}

/// Takes the youngest rays off the stack into the batch, class by class, in their order; ends[c] is
/// where class c ends.
inline void pop(const Shader& s, RayStack& stack, int (&ends)[kClasses]) {
  const int top = stack.size;
  const int n = std::min(top, s.work.take);
  stack.size -= n;
  int to = 0;
  for (int c = 0; c < kClasses; ++c) {
    for (int i = 0; i < n; i += kSimdWidth) {
      const int from = stack.size + i;
      const VUint depth = load_words<VFloat>(stack.depth + from);
      const unsigned refracted = bits_where(depth >= kRefracted);
      const CompressMask here((c == 0 ? ~refracted : refracted) & first_bits(from, top));
      if (here.count() == 0)
        continue;
      move_rays(s, stack, StackMove(here, from, to));
      here.store(s.b.rays.depth + to, depth & ~kRefracted);
      to += here.count();
    }
    ends[c] = to;
  }
}

/// Traces camera rays [0, count) of the batch and all their descendants. The stack is empty before
/// and after.
inline void follow(const Shader& s, RayStack& stack, int count) {
  s.rays.primary += static_cast<unsigned>(count);
  if (keeps_shares(s))
    std::fill(s.b.rays.share, s.b.rays.share + count, 1.f);
  shade_batch(s, stack, &count, 1, Phase::primary);
  int ends[kClasses];
  while (stack.size > 0) {
    enter(s.work, Phase::children);
    pop(s, stack, ends);
    shade_batch(s, stack, ends, kClasses, Phase::bounce);
  }
  enter(s.work, Phase::camera);
}

/// Collects samples at positions in the picture and renders them, a full batch at a time; see
/// camera_rays().
class CameraBatch {
 public:
  CameraBatch(const Shader& s, const FrameView& frame, bool in_pixels)
      : s_(s), frame_(frame), stack_(s.work.stack), in_pixels_(in_pixels) {
    stack_.size = 0;
  }
  void add(float x, float y, std::uint32_t sum, std::uint32_t first, std::uint32_t count) {
    BatchRays& b = s_.b.rays;
    int at = size_;
    for (std::uint32_t i = 0; i < count; ++i) {
      b.org.x[at] = x;
      b.org.y[at] = y;
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

struct TilePixels {
  std::uint8_t x[kTile * kTile], y[kTile * kTile];
  constexpr TilePixels() : x{}, y{} {
    for (int k = 0; k < kTile * kTile; ++k) {
      x[k] = static_cast<std::uint8_t>(tile_x(k));
      y[k] = static_cast<std::uint8_t>(tile_y(k));
    }
  }
};
inline constexpr TilePixels kTilePixels;

/// Renders a part of at most kStripRows rows into work.sums.
///
/// Depths never fall towards the top of the stack. Rays of depth d + 1 are only added while fewer
/// than `take` such rays are there, and by at most c take. A hit sends c rays: 2, or glossy_rays +
/// 2 with rough mirrors. So the stack holds at most c kBatch + c take (depth - 2) rays however the
/// light bounces.
inline void render_strip(const SceneView& scene,
                         const ShadingView& shading,
                         const FrameView& frame,
                         const Part& part,
                         const StripWork& work,
                         TraceCounts& counters,
                         RayCounts& rays) {
  const int y0 = part.rows.begin;
  const int y1 = part.rows.end;
  const Shader shader{scene, shading, work, counters, rays, *work.batch};
  CameraBatch batch(shader, frame, true);
  const auto first = static_cast<std::uint32_t>(part.samples.begin);
  const auto count = static_cast<std::uint32_t>(part.samples.end) - first;
  for (int x0 = 0; x0 < frame.width; x0 += kTile)
    for (int k = 0; k < kTile * kTile; ++k) {
      const int x = x0 + kTilePixels.x[k];
      const int y = y0 + kTilePixels.y[k];
      if (x >= frame.width || y >= y1)
        continue;
      const auto sum = static_cast<std::uint32_t>((y - y0) * frame.width + x);
      batch.add(static_cast<float>(x), static_cast<float>(y), sum, first, count);
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
                        const StripWork& work,
                        TraceCounts& counters,
                        RayCounts& rays) {
  const Shader shader{scene, shading, work, counters, rays, *work.batch};
  CameraBatch batch(shader, frame, true);
  const auto width = static_cast<std::uint32_t>(frame.width);
  for (int r = 0; r < count; ++r)
    for (std::uint32_t p = 0; p < kParts; ++p) {
      const PixelRun& run = runs[r];
      const std::uint32_t part = run.count / kParts;
      const auto x = static_cast<float>(run.pixel % width);
      const auto y = static_cast<float>(run.pixel / width);
      const std::uint32_t sum = static_cast<std::uint32_t>(r) * kParts + p;
      batch.add(x, y, sum, run.first + p * part, part);
    }
  batch.finish();
}

/// Adds all samples of each point to the point's sum, for adaptive subdivision. Points that stand
/// next to each other make a packet.
inline void render_points(const SceneView& scene,
                          const ShadingView& shading,
                          const FrameView& frame,
                          const PointList& points,
                          const StripWork& work,
                          TraceCounts& counters,
                          RayCounts& rays) {
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
