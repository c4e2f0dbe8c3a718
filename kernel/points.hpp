#pragma once
// Camera rays through given points of the picture, from camera to finished sums: what adaptive subdivision asks for.

#include "kernel/band.hpp"

namespace grelha::GRELHA_ISA {

/// Ray `index` through point `point` of the picture. The point is given: the only thing to sample is the lens.
inline void point_ray(const FrameView& f, const SamplePlan& plan, Batch& b, int at, const PointList& points, int point, std::uint32_t index) {
  const float sx = points.x[point] - .5f * static_cast<float>(f.width), sy = .5f * static_cast<float>(f.height) - points.y[point];
  Vec3<float> org{f.eye[0], f.eye[1], f.eye[2]};
  Vec3<float> d{(f.forward[0] + sx * f.right[0]) + sy * f.up[0], (f.forward[1] + sx * f.right[1]) + sy * f.up[1],
                (f.forward[2] + sx * f.right[2]) + sy * f.up[2]};
  if (f.lens) {
    const Pair p = disc_point(sample_pair(plan, points.hash[point], index, plan.lens, 0, plan.pixel_strata));
    const Vec3<float> on{p.u * f.lens_right[0] + p.v * f.lens_up[0], p.u * f.lens_right[1] + p.v * f.lens_up[1],
                         p.u * f.lens_right[2] + p.v * f.lens_up[2]};
    org = org + on, d = f.focus * d - on;
  }
  d = normalize(d);
  b.ox[at] = org.x, b.oy[at] = org.y, b.oz[at] = org.z;
  b.dx[at] = d.x, b.dy[at] = d.y, b.dz[at] = d.z;
  b.wr[at] = b.wg[at] = b.wb[at] = 1;
  b.pixel[at] = static_cast<std::uint32_t>(point), b.depth[at] = 1;
  if (plan.on) b.sample[at] = index, b.path[at] = 0;
}

/// Renders all samples of each point into the point's sum. Points that stand next to each other make a packet.
inline void render_points(const SceneView& scene, const ShadingView& shading, const FrameView& frame, const PointList& points,
                          const BandWork& work, Counters& counters, RayTally& rays) {
  const Shader shader{scene, shading, work, counters, rays, *work.batch};
  RayStack stack = work.stack;
  stack.size = 0;
  int count = 0;
  for (int point = 0; point < points.count; ++point)
    for (int i = 0; i < work.plan.samples; ++i) {
      point_ray(frame, work.plan, *work.batch, count, points, point, static_cast<std::uint32_t>(i));
      if (++count == kBatch) finish_batch(shader, stack, count), count = 0;
    }
  if (count > 0) finish_batch(shader, stack, count);
}

}  // namespace grelha::GRELHA_ISA
