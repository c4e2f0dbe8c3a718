#pragma once
// Camera rays through given points of the picture, from camera to finished sums: what adaptive subdivision asks for.

#include "kernel/band.hpp"

namespace grelha::GRELHA_ISA {

/// Rays of the batch through points of the picture, one a ray and given: the only thing to sample is the lens. Arrays are as
/// long as the batch; what they hold behind `count` is harmless.
struct PointRays {
  alignas(64) float x[kBatch] = {}, y[kBatch] = {};
  alignas(64) std::uint32_t name[kBatch] = {}, index[kBatch] = {};
};

[[gnu::noinline]] inline void point_rays(const FrameView& f, const SamplePlan& plan, Batch& b, const PointRays& rays, int count) {
  const auto splat = [](const float (&v)[3]) { return Vec3<Lanes>{Lanes(v[0]), Lanes(v[1]), Lanes(v[2])}; };
  const Vec3<Lanes> eye = splat(f.eye), forward = splat(f.forward), right = splat(f.right), up = splat(f.up);
  const Lanes half_width(.5f * static_cast<float>(f.width)), half_height(.5f * static_cast<float>(f.height));
  for (int i = 0; i < count; i += kWidth<Lanes>) {
    const Lanes sx = load<Lanes>(rays.x + i) - half_width, sy = half_height - load<Lanes>(rays.y + i);
    Vec3<Lanes> d = (forward + sx * right) + sy * up, org = eye;
    if (f.lens) {
      const PairOf<Lanes> p = disc_point(sample_pairs<Lanes>(plan, load_words<Lanes>(rays.name + i), load_words<Lanes>(rays.index + i), plan.lens,
                                                             Words<Lanes>{}, plan.pixel_strata));
      const Vec3<Lanes> on = p.u * splat(f.lens_right) + p.v * splat(f.lens_up);
      org = eye + on, d = Lanes(f.focus) * d - on;
    }
    d = normalize(d);
    store(b.ox + i, org.x), store(b.oy + i, org.y), store(b.oz + i, org.z);
    store(b.dx + i, d.x), store(b.dy + i, d.y), store(b.dz + i, d.z);
  }
}

/// Renders all samples of each point into the point's sum. Points that stand next to each other make a packet.
inline void render_points(const SceneView& scene, const ShadingView& shading, const FrameView& frame, const PointList& points,
                          const BandWork& work, Counters& counters, RayTally& tally) {
  Batch& b = *work.batch;
  const Shader shader{scene, shading, work, counters, tally, b};
  RayStack stack = work.stack;
  stack.size = 0;
  PointRays rays;
  int count = 0;
  const auto finish = [&] {
    point_rays(frame, work.plan, b, rays, count);
    follow(shader, stack, count);
    count = 0;
  };
  for (int point = 0; point < points.count; ++point)
    for (int i = 0; i < work.plan.samples; ++i) {
      rays.x[count] = points.x[point], rays.y[count] = points.y[point];
      rays.name[count] = work.pixels[point], rays.index[count] = static_cast<std::uint32_t>(i);
      b.wr[count] = b.wg[count] = b.wb[count] = 1;
      b.pixel[count] = static_cast<std::uint32_t>(point), b.depth[count] = 1;
      b.sample[count] = static_cast<std::uint32_t>(i), b.path[count] = 0;
      if (++count == kBatch) finish();
    }
  if (count > 0) finish();
}

}  // namespace grelha::GRELHA_ISA
