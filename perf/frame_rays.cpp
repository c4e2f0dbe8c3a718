#include "perf/frame_rays.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>

#include <omp.h>

#include "kernel/world/world_impl.hpp"

namespace grelha::perf {
namespace {

class Recorder : public Observer {
 public:
  explicit Recorder(FrameRays& frame) : Observer{&Recorder::enter}, frame_(frame) {}

 private:
  static void enter(Observer& self, Phase phase, const Rays* rays) {
    if (!rays || rays->count == 0)
      return;
    RaySet& set = static_cast<Recorder&>(self).frame_[phase == Phase::primary  ? 0
                                                      : phase == Phase::bounce ? 1
                                                                               : 2];
    set.runs.push_back({set.rays.size(), rays->count});
    RayBuffer& r = set.rays;
    const auto put = [n = rays->count](
                         std::vector<float>& to, const float* from, std::ptrdiff_t stride) {
      for (std::size_t i = 0; i < n; ++i)
        to.push_back(from[static_cast<std::ptrdiff_t>(i) * stride]);
    };
    const float nothing = 0;
    const float infinity = __builtin_inff();
    put(r.ox, rays->org[0], rays->org_stride);
    put(r.oy, rays->org[1], rays->org_stride);
    put(r.oz, rays->org[2], rays->org_stride);
    put(r.dx, rays->dir[0], rays->dir_stride);
    put(r.dy, rays->dir[1], rays->dir_stride);
    put(r.dz, rays->dir[2], rays->dir_stride);
    put(r.t_min, rays->t_min ? rays->t_min : &nothing, rays->t_min ? rays->t_stride : 0);
    put(r.t_max, rays->t_max ? rays->t_max : &infinity, rays->t_max ? rays->t_stride : 0);
  }
  FrameRays& frame_;
};

}  // namespace

double now_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

FrameRays rays_of_frame(const World& world, const Camera& camera, RenderOptions options) {
  FrameRays frame;
  Recorder recorder(frame);
  options.threads = 1;
  options.observer = &recorder;
  RenderStats stats;
  render(world, camera, options, stats);
  return frame;
}

FrameRays thinned(const FrameRays& frame, std::size_t stride) {
  FrameRays out;
  for (std::size_t kind = 0; kind < frame.size(); ++kind) {
    const RayBuffer& r = frame[kind].rays;
    RaySet& to = out[kind];
    for (std::size_t i = stride / 2; i < r.size(); i += stride)
      to.rays.add({r.ox[i], r.oy[i], r.oz[i]}, {r.dx[i], r.dy[i], r.dz[i]}, r.t_max[i]);
    for (std::size_t i = 0; i < to.rays.size(); i += kBatch)
      to.runs.push_back({i, std::min<std::size_t>(kBatch, to.rays.size() - i)});
  }
  return out;
}

std::array<double, 3> trace_seconds(const World& world,
                                    const Variant& variant,
                                    const TraceOptions& settings,
                                    const FrameRays& frame,
                                    int threads) {
  std::array<double, 3> seconds{};
  for (std::size_t kind = 0; kind < frame.size(); ++kind) {
    const RayBuffer& r = frame[kind].rays;
    const auto& runs = frame[kind].runs;
    const auto now = threads == 1 ? cpu_seconds : now_seconds;
    const double start = now();
#pragma omp parallel num_threads(threads)
    {
      Answers answers;
      TraceCounts counts;
#pragma omp for schedule(dynamic, 8)
      for (std::size_t k = 0; k < runs.size(); ++k)
        trace(world,
              variant,
              settings,
              r.view(runs[k].first, runs[k].count),
              kind == 2,
              answers,
              counts);
    }
    seconds[kind] = now() - start;
  }
  return seconds;
}

}  // namespace grelha::perf
